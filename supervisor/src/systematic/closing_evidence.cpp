// SPDX-License-Identifier: BSD-3-Clause
#include "systematic/closing_evidence.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <variant>
#include <vector>

#include "systematic/spaced_out.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double most_stops = 200.0;

/// After its last scan or fix.
Tape::Position end_of_stops(const Tape& tape) {
  Tape::Position end = tape.end();
  const auto is_merge_or_solution = [&](Tape::Position at) {
    bool is = false;
    tape.read_between(at, at + 1, [&](const Tape::Entry& entry) {
      is = std::holds_alternative<Tape::Merge>(entry) || std::holds_alternative<Tape::Solved>(entry);
    });
    return is;
  };
  while (end > tape.begin() && is_merge_or_solution(end - 1)) --end;
  return end;
}

core::MergedIds merged_before(const Tape& tape, Tape::Position until) {
  core::MergedIds ids;
  tape.read_between(tape.begin(), until, [&](const Tape::Entry& entry) {
    const auto* merge = std::get_if<Tape::Merge>(&entry);
    if (merge == nullptr) return;
    for (const core::MergedLandmarks& one : merge->merged) ids.merge(one);
  });
  return ids;
}

/// Length of road up to each stop.
std::vector<double> driven_to(const std::vector<Stop>& stops) {
  std::vector<double> driven_m;
  double path_m = 0.0;
  for (const Stop& stop : stops) {
    if (stop.motion) path_m += stop.motion->T_before_after.position_m().norm();
    driven_m.push_back(path_m);
  }
  return driven_m;
}

/// By present id: the landmarks before the closing that became it, with the stops that saw each.
std::map<core::LandmarkId, std::map<core::LandmarkId, std::vector<std::size_t>>> merged_sightings(
    const std::vector<Stop>& stops, const core::MergedIds& before, const core::MergedIds& now) {
  std::map<core::LandmarkId, std::map<core::LandmarkId, std::vector<std::size_t>>> sightings;
  for (std::size_t k = 0; k < stops.size(); ++k) {
    for (const cekf::Match& match : stops[k].seen) {
      const core::LandmarkId id = before.now(match.landmark);
      sightings[now.now(id)][id].push_back(k);
    }
  }
  for (auto one = sightings.begin(); one != sightings.end();) {
    one = one->second.size() < 2 ? sightings.erase(one) : std::next(one);
  }
  return sightings;
}

/// Length of road at which an old landmark of the closing was last seen before its copy was: the earliest over all of them.
std::optional<double> begin_of_loop(const std::vector<Stop>& stops, const std::vector<double>& driven_m,
                                    const core::MergedIds& before, const core::MergedIds& now) {
  std::optional<double> begun_m;
  for (const auto& [id, parts] : merged_sightings(stops, before, now)) {
    std::size_t newest = 0;  // first sighting of the part that was begun last
    for (const auto& [part, seen] : parts) newest = std::max(newest, seen.front());
    std::size_t last = 0;
    for (const auto& [part, seen] : parts) {
      const auto after = std::lower_bound(seen.begin(), seen.end(), newest);
      if (after != seen.begin()) last = std::max(last, *std::prev(after));
    }
    begun_m = std::min(begun_m.value_or(driven_m[last]), driven_m[last]);
  }
  return begun_m;
}

/// For each stop where the path has it, or as far from the stop before as odometry says.
std::vector<core::Pose2> poses_of(const std::vector<Stop>& stops, const std::vector<core::StampedPose>& path) {
  std::map<core::Nanoseconds, core::Pose2> at;
  for (const core::StampedPose& pose : path) at[pose.t_ns] = pose.T_world_robot;
  std::vector<core::Pose2> poses;
  for (const Stop& stop : stops) {
    const auto found = at.find(stop.t_ns);
    const core::Pose2 before = poses.empty() ? core::Pose2() : poses.back();
    poses.push_back(found != at.end() ? found->second
                    : stop.motion     ? core::compose(before, stop.motion->T_before_after)
                                      : before);
  }
  return poses;
}

std::vector<Stop> named(std::vector<Stop> stops, const core::MergedIds& ids) {
  for (Stop& stop : stops) {
    for (cekf::Match& match : stop.seen) match.landmark = ids.now(match.landmark);
  }
  return stops;
}

std::optional<StretchEvidence> difference(const std::optional<StretchEvidence>& with,
                                          const std::optional<StretchEvidence>& without) {
  constexpr double little = 0.1;  // of χ²
  if (!with || !without || !(with->left < little) || !(without->left < little)) return std::nullopt;
  StretchEvidence added;
  added.information = with->information - without->information;
  added.gradient = with->gradient - without->gradient;
  added.chi2 = with->chi2 - without->chi2;
  added.dof = with->dof - without->dof;
  return added;
}

}  // namespace

std::vector<Stop> stops_of_closing(const Tape& tape, double reach_m) {
  if (!tape.holds_drive()) return {};
  const Tape::Position end = end_of_stops(tape);
  std::vector<Stop> stops = stops_between(tape, tape.begin(), end);
  const std::vector<double> driven_m = driven_to(stops);
  const std::optional<double> begun_m = begin_of_loop(stops, driven_m, merged_before(tape, end), merged_ids(tape));
  if (!begun_m) return {};
  const auto first = std::lower_bound(driven_m.begin(), driven_m.end(), *begun_m - reach_m);
  const double spacing_m = std::max(0.25 * reach_m, (driven_m.back() - *first) / most_stops);
  if (spacing_m > 0.5 * reach_m) return {};
  stops.erase(stops.begin(), stops.begin() + (first - driven_m.begin()));
  return spaced_out(stops, spacing_m);
}

std::optional<StretchEvidence> evidence_of_closing(const Tape& tape, const std::vector<core::StampedPose>& path,
                                                   double reach_m) {
  const std::vector<Stop> stops = stops_of_closing(tape, reach_m);
  if (stops.empty()) return std::nullopt;
  const std::vector<core::Pose2> near = path.empty() ? std::vector<core::Pose2>() : poses_of(stops, path);
  constexpr int most_iterations = 12;
  const core::MergedIds before = merged_before(tape, end_of_stops(tape));
  return difference(evidence_of_stretch(named(stops, merged_ids(tape)), near, most_iterations),
                    evidence_of_stretch(named(stops, before), near, most_iterations));
}

}  // namespace helixnav::supervisor
