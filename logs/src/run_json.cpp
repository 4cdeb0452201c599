// SPDX-License-Identifier: BSD-3-Clause
#include "run_json.hpp"

#include <algorithm>
#include <numeric>

#include "helixnav/core/errors.hpp"
#include "run_words.hpp"

namespace helixnav::logs {

namespace {

constexpr const char* format_name = "helixnav-run 2";

Json config_to_json(const std::string& config) {
  const Json parsed = Json::parse(config, nullptr, false);
  return parsed.is_object() || parsed.is_array() ? parsed : Json(config);
}

void put(Json& object, const std::string& dotted_key, double value) {
  const std::size_t dot = dotted_key.find('.');
  if (dot == std::string::npos) {
    object[dotted_key] = value;
  } else {
    put(object[dotted_key.substr(0, dot)], dotted_key.substr(dot + 1), value);
  }
}

Json closures_to_json(const RunFolder& run) {
  std::int64_t accepted = 0, refused = 0, undecided = 0;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      const auto* closure = std::get_if<core::ClosureDecision>(&decision);
      accepted += closure != nullptr && closure->accepted;
      refused += closure != nullptr && !closure->accepted;
      undecided += std::holds_alternative<core::UndecidedDecision>(decision);
    }
  }
  return {{"accepted", accepted}, {"refused", refused}, {"undecided", undecided}};
}

std::int64_t count_landmarks(const RunFolder& run, core::LandmarkState state) {
  return std::count_if(run.map.begin(), run.map.end(),
                       [&](const core::MapLandmark& landmark) { return landmark.state == state; });
}

Json observations_to_json(const RunFolder& run) {
  std::array<std::int64_t, outcome_words.size()> counts{};
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) ++counts[static_cast<std::size_t>(a.outcome)];
  }
  Json json = Json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) json[std::string(outcome_words[i])] = counts[i];
  return json;
}

}  // namespace

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

Json manifest_to_json(const RunManifest& manifest) {
  Json inputs = Json::array();
  for (const InputFile& input : manifest.inputs) inputs.push_back({{"name", input.name}, {"sha256", input.sha256}});
  return {{"format", format_name},
          {"version", manifest.version},
          {"commit", manifest.commit},
          {"command", manifest.command},
          {"recording", manifest.recording},
          {"seed", manifest.seed},
          {"inputs", inputs},
          {"config", config_to_json(manifest.config)}};
}

RunManifest manifest_from_text(const std::string& path, const std::string& text) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != format_name) {
      throw core::InputError(path + ": format is " + json.at("format").dump() + ", expected \"" + format_name + '"');
    }
    RunManifest manifest;
    manifest.version = json.at("version").get<std::string>();
    manifest.commit = json.at("commit").get<std::string>();
    manifest.command = json.at("command").get<std::string>();
    manifest.recording = json.at("recording").get<std::string>();
    manifest.seed = json.at("seed").get<std::uint64_t>();
    for (const Json& input : json.at("inputs")) {
      manifest.inputs.push_back({input.at("name").get<std::string>(), input.at("sha256").get<std::string>()});
    }
    const Json& config = json.at("config");
    manifest.config = config.is_string() ? config.get<std::string>() : config.dump(2);
    return manifest;
  } catch (const Json::exception& error) {
    throw core::InputError(path + ": not a manifest of a run: " + error.what());
  }
}

Json timing_to_json(const std::vector<double>& microseconds,
                    const std::vector<std::pair<std::string, double>>& timing) {
  const ErrorStatistics step = error_statistics(microseconds);
  std::vector<double> sorted = microseconds;
  std::sort(sorted.begin(), sorted.end());
  Json json = Json::object();
  json["median_us"] = step.median;
  json["p99_us"] = quantile_of_sorted(sorted, 0.99);
  json["max_us"] = step.max;
  json["steps_s"] = std::accumulate(sorted.begin(), sorted.end(), 0.0) * 1e-6;
  for (const auto& [name, value] : timing) json[name] = value;
  return json;
}

Json summary_to_json(const RunFolder& run, const Evaluation& evaluation,
                     const std::vector<std::pair<std::string, double>>& numbers) {
  Json json = Json::object();
  json["steps"] = run.steps.size();
  json["landmarks"] = {{"mature", count_landmarks(run, core::LandmarkState::mature)},
                       {"tentative", count_landmarks(run, core::LandmarkState::tentative)}};
  json["closures"] = closures_to_json(run);
  json["observations"] = observations_to_json(run);
  json.update(evaluation_to_json(evaluation));
  for (const auto& [key, value] : numbers) put(json, key, value);
  return json;
}

}  // namespace helixnav::logs
