// SPDX-License-Identifier: BSD-3-Clause
#include "run_warnings.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <variant>

#include "has_match.hpp"
#include "helixnav/reports/run_warnings.hpp"
#include "helixnav/runs/joint_map_file.hpp"

namespace helixnav::apps {
namespace {

/// As the user calls it.
std::string name_of(const runs::Run& run, core::LandmarkId id) {
  const auto found = run.names.find(id);
  return found == run.names.end() ? std::to_string(id) : "'" + found->second + "'";
}

/// Empty unless sightings were left out of the landmark that they name.
std::string names_text(const runs::Run& run) {
  std::map<core::LandmarkId, std::size_t> contradicted;
  std::size_t all = 0;
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) {
      if (a.outcome != core::Outcome::rejected || a.landmark == core::no_landmark) continue;
      ++contradicted[a.landmark];
      ++all;
    }
  }
  if (all == 0) return {};
  const auto most = std::max_element(contradicted.begin(), contradicted.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return std::to_string(all) + " sightings contradict their names and were left out, most of them (" +
         std::to_string(most->second) + ") of landmark " + name_of(run, most->first) +
         ": some identities are wrong, or landmarks were moved. 'helixnav explain --step N' shows a scan";
}

/// Where another session cannot continue in the map.
std::string unsaved_text(const Drive& job, const runs::Run& run) {
  const bool is_large = run.map.size() > runs::most_joint_landmarks;
  if (run.joint_map || !is_large || job.given_map || job.fastslam.chosen) return {};
  return "no session can continue in this map (there is no map.bin): it has " + std::to_string(run.map.size()) +
         " landmarks, more than a joint covariance is kept for, and " +
         (job.earlier
              ? std::string("the map in which the session began holds no factors of its drive: one made by names, "
                            "without searches or by an earlier version does not")
              : std::string("its drive was not kept (search.enabled, search.smooth_up_to_scans)"));
}

/// Counts of detections: those of landmarks of the given map (not begun in this run), and all in the scans that have one.
struct OnGivenMap {
  std::size_t seen = 0, of_map = 0, seen_beside = 0;
};

OnGivenMap count_on_given_map(const runs::Run& run) {
  OnGivenMap counts;
  std::set<core::LandmarkId> begun;
  for (const core::StepReport& step : run.steps) {
    std::size_t of_map = 0;
    for (const core::AssociationReport& a : step.associations) {
      if (a.outcome == core::Outcome::augmented) begun.insert(a.landmark);
      of_map += a.outcome == core::Outcome::matched && begun.count(a.landmark) == 0 ? 1 : 0;
    }
    counts.seen += step.associations.size();
    counts.of_map += of_map;
    counts.seen_beside += of_map > 0 ? step.associations.size() : 0;
  }
  return counts;
}

/// Empty unless hardly anything seen belongs to the map on which the start was given, or only the odd detection among many that do
/// not, as happens by chance at a wrong place: on the map most of what a scan shows belongs to it.
std::string given_start_text(const runs::Run& run) {
  const OnGivenMap counts = count_on_given_map(run);
  constexpr std::size_t enough = 200;
  constexpr std::size_t most_times = 50;
  // Of all, and of those in scans with one of the map: wrong starts at most 0.08 and 0.24, right ones at least 0.63 and 0.66.
  constexpr double little = 0.2, chance = 0.4;
  const auto of_map = static_cast<double>(counts.of_map);
  const bool by_chance =
      of_map < little * static_cast<double>(counts.seen) && of_map < chance * static_cast<double>(counts.seen_beside);
  if (counts.seen < enough || (most_times * counts.of_map > counts.seen && !by_chance)) return {};
  return "of " + std::to_string(counts.seen) + " detections " + std::to_string(counts.of_map) +
         " were matched with the map given: the vehicle left it at once, or the start given is wrong and the map now "
         "holds landmarks twice; --start unknown finds the start itself";
}

/// Empty if the start that was given on an earlier map is right as far as can be told.
std::string doubted_start_text(const runs::Run& run) {
  const bool was_wrong = std::any_of(run.steps.begin(), run.steps.end(), [](const core::StepReport& step) {
    return std::any_of(step.decisions.begin(), step.decisions.end(), reports::is_wrong_start);
  });
  if (was_wrong) {
    const bool is_given = run.manifest.command.find("--start") != std::string::npos;
    const std::string what = is_given
                                 ? "the start given (--start) is wrong or off the map"
                                 : "the start that the log gives is wrong or off the map (--start unknown gives none)";
    return what +
           ": what was seen does not fit the map there. It was dropped, and the place searched for; 'helixnav explain' "
           "says when and with what result";
  }
  const bool is_ambiguous = std::any_of(run.numbers.begin(), run.numbers.end(),
                                        [](const auto& number) { return number.first == start_is_ambiguous; });
  return is_ambiguous ? "the start given was taken on trust: the landmarks seen fit several places on the map. If it "
                        "is off by a row, or by one landmark of many alike, the whole drive is off by as much, and its "
                        "covariance does not say so"
                      : "";
}

}  // namespace

std::vector<std::string> warnings_of(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  std::vector<std::string> warnings = reports::warnings_of(run, evaluation);
  if (const std::string text = reports::place_not_found_text(run); !text.empty()) warnings.push_back(text);
  warnings.insert(warnings.end(), run.warnings.begin(), run.warnings.end());
  return warnings;
}

std::vector<std::string> warnings_of_job(const Drive& job, const runs::Run& run) {
  std::vector<std::string> warnings;
  const bool mature = std::any_of(run.map.begin(), run.map.end(), [](const core::MapLandmark& landmark) {
    return landmark.state == core::LandmarkState::mature;
  });
  if (job.known_association && mature && std::none_of(run.steps.begin(), run.steps.end(), has_match)) {
    warnings.emplace_back("no identity was seen twice: --association known needs persistent identities");
  }
  if (job.known_association) {
    const std::string text = names_text(run);
    if (!text.empty()) warnings.push_back(text);
  }
  if (const std::string text = doubted_start_text(run); !text.empty()) warnings.push_back(text);
  if (const std::string text = unsaved_text(job, run); !text.empty()) warnings.push_back(text);
  if (job.earlier && job.earlier->start.kind == SessionStart::Kind::pose) {
    const std::string text = given_start_text(run);
    if (!text.empty()) warnings.push_back(text);
  }
  return warnings;
}

}  // namespace helixnav::apps
