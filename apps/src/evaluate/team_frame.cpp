// SPDX-License-Identifier: BSD-3-Clause
#include "team_frame.hpp"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "helixnav/files/file.hpp"
#include "helixnav/files/json_nesting.hpp"

namespace helixnav::apps {

std::optional<double> in_frame_since_s(const std::string& folder) {
  using TeamJson = nlohmann::json;
  const std::filesystem::path robot = std::filesystem::absolute(folder + "/.").lexically_normal().parent_path();
  const std::string summary = (robot.parent_path() / "summary.json").string();
  if (robot.filename().string().rfind("robot_", 0) != 0 || !std::filesystem::is_regular_file(summary)) return {};
  const std::string text = files::read_whole_file(summary);
  files::check_json_nesting(summary, text);
  const TeamJson json = TeamJson::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("robots") || !json.at("robots").is_array()) return {};
  for (const TeamJson& one : json.at("robots")) {
    if (!one.is_object() || !one.contains("robot") || !one.at("robot").is_number_integer()) continue;
    if (robot.filename().string() != "robot_" + one.at("robot").dump()) continue;
    const auto since = one.find("in_frame_since_s");
    if (since != one.end() && since->is_number()) return since->get<double>();
  }
  return {};
}

}  // namespace helixnav::apps
