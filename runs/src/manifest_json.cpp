// SPDX-License-Identifier: BSD-3-Clause
#include "manifest_json.hpp"

#include <nlohmann/json.hpp>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/json_nesting.hpp"

namespace helixnav::runs {
namespace {

/// Keys keep the order in which they were put in.
using Json = nlohmann::ordered_json;

constexpr const char* format_name = "helixnav-run 2";

Json config_to_json(const std::string& config) {
  const Json parsed = Json::parse(config, nullptr, false);
  return parsed.is_object() || parsed.is_array() ? parsed : Json(config);
}

}  // namespace

std::string manifest_json(const RunManifest& manifest) {
  Json inputs = Json::array();
  for (const InputFile& input : manifest.inputs) inputs.push_back({{"name", input.name}, {"sha256", input.sha256}});
  const Json json = {{"format", format_name},
                     {"version", manifest.version},
                     {"commit", manifest.commit},
                     {"command", manifest.command},
                     {"recording", manifest.recording},
                     {"seed", manifest.seed},
                     {"inputs", inputs},
                     {"config", config_to_json(manifest.config)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

RunManifest manifest_from_text(const std::string& path, const std::string& text) {
  files::check_json_nesting(path, text);
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

}  // namespace helixnav::runs
