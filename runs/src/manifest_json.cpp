// SPDX-License-Identifier: BSD-3-Clause
#include "manifest_json.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/json_nesting.hpp"

namespace helixnav::runs {
namespace {

/// Keys keep the order in which they were inserted.
using Json = nlohmann::ordered_json;

constexpr const char* format_name = "helixnav-run 2";

Json config_to_json(const std::string& config) {
  const Json parsed = Json::parse(config, nullptr, false);
  return parsed.is_object() || parsed.is_array() ? parsed : Json(config);
}

/// The values of a manifest's object, of the requested kind. InputError with file and key for any other.
class ManifestValues {
 public:
  ManifestValues(const std::string& path, const Json& json, std::string place = "")
      : path_(path), json_(json), place_(std::move(place)) {}

  const Json& at(const char* key) const {
    if (!json_.is_object() || !json_.contains(key)) refuse(key, "is missing");
    return json_.at(key);
  }
  std::string word(const char* key) const {
    const Json& value = at(key);
    if (!value.is_string()) refuse_kind(key, "a text");
    return value.get<std::string>();
  }
  std::uint64_t count(const char* key) const {
    const Json& value = at(key);
    if (!value.is_number_unsigned()) refuse_kind(key, "a whole number from 0 on");
    return value.get<std::uint64_t>();
  }
  const Json& list(const char* key) const {
    const Json& value = at(key);
    if (!value.is_array()) refuse_kind(key, "a list");
    return value;
  }

 private:
  [[noreturn]] void refuse(const char* key, const std::string& problem) const {
    throw core::InputError(path_ + ": not a manifest of a run: " + place_ + '"' + key + "\" " + problem);
  }
  [[noreturn]] void refuse_kind(const char* key, const char* expected) const {
    constexpr std::size_t most_shown = 60;
    refuse(key, "is " + json_.at(key).dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, most_shown) +
                    ", expected " + expected);
  }

  const std::string& path_;
  const Json& json_;
  std::string place_;
};

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
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw core::InputError(path + ": not a manifest of a run: no JSON");
  const ManifestValues values(path, json);
  if (values.at("format") != format_name) {
    throw core::InputError(path + ": format is " + json.at("format").dump() + ", expected \"" + format_name + '"');
  }
  RunManifest manifest;
  manifest.version = values.word("version");
  manifest.commit = values.word("commit");
  manifest.command = values.word("command");
  manifest.recording = values.word("recording");
  manifest.seed = values.count("seed");
  for (const Json& input : values.list("inputs")) {
    const ManifestValues of_input(path, input, "\"inputs\": ");
    manifest.inputs.push_back({of_input.word("name"), of_input.word("sha256")});
  }
  const Json& config = values.at("config");
  manifest.config = config.is_string() ? config.get<std::string>() : config.dump(2);
  return manifest;
}

}  // namespace helixnav::runs
