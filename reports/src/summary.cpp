// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/summary.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <variant>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/runs/words.hpp"
#include "json.hpp"
#include "numerics_text.hpp"
#include "place_questions.hpp"
#include "wrong_place_text.hpp"

namespace helixnav::reports {

namespace {

void put(Json& object, const std::string& dotted_key, double value) {
  const std::size_t dot = dotted_key.find('.');
  if (dot == std::string::npos) {
    object[dotted_key] = value;
  } else {
    put(object[dotted_key.substr(0, dot)], dotted_key.substr(dot + 1), value);
  }
}

Json closures_to_json(const runs::Run& run) {
  std::int64_t accepted = 0, refused = 0, undecided = 0, new_ground = 0;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      const auto* closure = std::get_if<core::ClosureDecision>(&decision);
      accepted += closure != nullptr && closure->accepted;
      refused += closure != nullptr && !closure->accepted;
      undecided += std::holds_alternative<core::UndecidedDecision>(decision);
      new_ground += std::holds_alternative<core::NewGroundDecision>(decision);
    }
  }
  return {{"accepted", accepted}, {"refused", refused}, {"new_ground", new_ground}, {"undecided", undecided}};
}

bool asked_for_place(const runs::Run& run) {
  return std::any_of(run.steps.begin(), run.steps.end(), [](const core::StepReport& step) {
    return std::any_of(step.decisions.begin(), step.decisions.end(), [](const core::Decision& decision) {
      return std::holds_alternative<core::PlacedDecision>(decision);
    });
  });
}

/// For the part in which the run ends, as in `explain`: a place that was found stays found, whatever is asked about other parts
/// later, until the vehicle is carried.
Json placed_to_json(const PlaceQuestions& asked) {
  Json json = {{"found", asked.accepted.has_value()}};
  if (asked.accepted) {
    const core::PlacedDecision& accepted = *asked.accepted;
    json.update({{"last", core::row_of(accepted).verdict},
                 {"driven_m", accepted.driven_m},
                 {"questions", accepted.questions},
                 {"pairs", accepted.pairs}});
    return json;
  }
  json["last"] = core::row_of(asked.last.value_or(core::PlacedDecision())).verdict;
  json.update({{"questions", asked.questions}, {"most_landmarks", asked.most_landmarks}});
  if (!asked.best) return json;
  const core::PlacedDecision& best = *asked.best;
  json.update({{"asked_from_m", asked.from_m}, {"asked_to_m", asked.to_m}});
  json["best"] = {{"question", best.questions}, {"landmarks", best.landmarks}, {"pairs", best.pairs},
                  {"evidence", best.evidence},  {"lead", best.lead},           {"needed", best.needed}};
  return json;
}

/// How often the vehicle was carried (event lost); nothing if it was not.
std::optional<Json> carried_to_json(const runs::Run& run) {
  int times = 0;
  bool is_placed = true;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      if (is_carried_off(decision)) {
        ++times;
        is_placed = false;
      }
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      is_placed = is_placed || (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted);
    }
  }
  if (times == 0) return std::nullopt;
  return Json{{"times", times}, {"found_since", is_placed}};
}

Json numerics_to_json(const runs::Run& run) {
  const core::NumericalHealth numerics = numerics_of(run);
  return {{"least_pivot", numerics.least_pivot},
          {"asymmetry", numerics.asymmetry},
          {"repaired", numerics.repaired},
          {"refused", numerics.refused}};
}

Json postponed_to_json(const PostponedWork& postponed) {
  return {{"scans_thinned", postponed.scans_thinned},
          {"scans_left_out", postponed.scans_left_out},
          {"associations", postponed.associations},
          {"windows", postponed.windows},
          {"drives", postponed.drives}};
}

std::int64_t count_landmarks(const runs::Run& run, core::LandmarkState state) {
  return std::count_if(run.map.begin(), run.map.end(),
                       [&](const core::MapLandmark& landmark) { return landmark.state == state; });
}

Json observations_to_json(const runs::Run& run) {
  std::array<std::int64_t, runs::outcome_words.size()> counts{};
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) ++counts[static_cast<std::size_t>(a.outcome)];
  }
  Json json = Json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) json[std::string(runs::outcome_words[i])] = counts[i];
  return json;
}

/// For the tables whose rows nothing else counts, so that a truncated one is noticed.
Json rows_to_json(const runs::Run& run) {
  std::size_t labels = 0, particles = 0;
  for (const auto& of_step : run.truth.labels) labels += of_step.size();
  for (const core::StepReport& step : run.steps) particles += step.particles ? 1 : 0;
  Json json = Json::object();
  const auto put_rows = [&](const char* table, std::size_t rows) {
    if (rows > 0) json[table] = rows;
  };
  put_rows("truth_poses", run.truth.poses.size());
  put_rows("truth_positions", run.truth.positions.size());
  put_rows("truth_landmarks", run.truth.landmarks.size());
  put_rows("truth_labels", labels);
  put_rows("particles", particles);
  return json;
}

}  // namespace

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

Json timing_to_json(const runs::Run& run) {
  const evaluation::ErrorStatistics step = evaluation::error_statistics(run.microseconds);
  std::vector<double> sorted = run.microseconds;
  std::sort(sorted.begin(), sorted.end());
  Json json = Json::object();
  json["median_us"] = step.median;
  json["p99_us"] = evaluation::quantile_of_sorted(sorted, 0.99);
  json["max_us"] = step.max;
  json["steps_s"] = std::accumulate(sorted.begin(), sorted.end(), 0.0) * 1e-6;
  for (const auto& [name, value] : run.timing) json[name] = value;
  return json;
}

Json summary_to_json(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  Json json = Json::object();
  json["steps"] = run.steps.size();
  json["landmarks"] = {{"mature", count_landmarks(run, core::LandmarkState::mature)},
                       {"tentative", count_landmarks(run, core::LandmarkState::tentative)}};
  json["closures"] = closures_to_json(run);
  if (asked_for_place(run)) json["placed"] = placed_to_json(questions_in(run));
  if (const auto carried = carried_to_json(run)) json["carried"] = *carried;
  json["observations"] = observations_to_json(run);
  json["numerics"] = numerics_to_json(run);
  if (const PostponedWork postponed = postponed_in(run); postponed.any()) {
    json["postponed"] = postponed_to_json(postponed);
  }
  if (const Json rows = rows_to_json(run); !rows.empty()) json["rows"] = rows;
  json.update(evaluation_to_json(evaluation));
  return json;
}

std::string summary_json(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  Json json = summary_to_json(run, evaluation);
  for (const auto& [key, value] : run.numbers) put(json, key, value);
  json["timing"] = timing_to_json(run);
  return json_text(json);
}

}  // namespace helixnav::reports
