// SPDX-License-Identifier: BSD-3-Clause
#include "missing_rows.hpp"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "helixnav/files/file.hpp"
#include "helixnav/files/json_nesting.hpp"

namespace helixnav::runs {
namespace {

using SummaryJson = nlohmann::json;

/// A count in an object; nothing for anything else.
std::optional<std::size_t> count_in(const SummaryJson& json, const char* key) {
  if (!json.is_object() || !json.contains(key) || !json.at(key).is_number_unsigned()) return std::nullopt;
  return json.at(key).get<std::size_t>();
}

/// Whole lines below the header.
std::size_t rows_in(const std::string& path) {
  const std::string text = files::read_whole_file(path);
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  return lines > 0 ? lines - 1 : 0;
}

}  // namespace

SaidOfRun read_said(const std::string& path) {
  const std::string text = files::read_whole_file(path);
  files::check_json_nesting(path, text);
  const SummaryJson json = SummaryJson::parse(text, nullptr, false);
  SaidOfRun said;
  said.steps = count_in(json, "steps");
  if (json.is_object() && json.contains("rows") && json.at("rows").is_object()) {
    for (const auto& [table, count] : json.at("rows").items()) {
      if (count.is_number_unsigned()) said.rows.emplace_back(table, count.get<std::size_t>());
    }
  }
  if (!json.is_object() || !json.contains("landmarks")) return said;
  const auto mature = count_in(json.at("landmarks"), "mature"), tentative = count_in(json.at("landmarks"), "tentative");
  if (mature && tentative) said.landmarks = *mature + *tentative;
  return said;
}

void tell_missing_rows(const std::string& folder, const SaidOfRun& said, std::vector<std::string>& missing) {
  for (const auto& [table, rows] : said.rows) {
    const bool is_name = table.find_first_of("/\\") == std::string::npos;
    const std::string file = table + ".csv";
    if (is_name && std::filesystem::is_regular_file(folder + '/' + file))
      tell_missing(folder, file, rows_in(folder + '/' + file), rows, missing);
  }
}

void tell_missing(const std::string& folder, std::string_view table, std::size_t found, std::size_t expected,
                  std::vector<std::string>& missing) {
  if (found >= expected) return;
  missing.push_back(folder + '/' + std::string(table) + ": " + std::to_string(found) + " of " +
                    std::to_string(expected) + " rows: the run came to its end, and the file was cut since");
}

}  // namespace helixnav::runs
