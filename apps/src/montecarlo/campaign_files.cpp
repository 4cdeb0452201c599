// SPDX-License-Identifier: BSD-3-Clause
#include "campaign_files.hpp"

#include <algorithm>
#include <cstddef>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/json_nesting.hpp"

namespace helixnav::apps {
namespace {

/// The keys that the summary reads from a row; numbers of any other type count as missing.
void check_row(const std::string& file, std::size_t line, const Json& row) {
  const std::string here = file + ':' + std::to_string(line) + ": expected the JSON object of a run";
  if (!row.is_object() || !row.contains("seed") || !row.contains("verdict")) throw core::InputError(here);
  const auto require = [&](const char* key, bool right) {
    if (!right) throw core::InputError(here + ", found \"" + key + "\": " + row.at(key).dump().substr(0, 60));
  };
  require("seed", row.at("seed").is_number_unsigned());
  require("verdict", row.at("verdict").is_string());
  for (const char* key : {"diverged_after_closure", "late", "closed_by_association"}) {
    if (row.contains(key)) require(key, row.at(key).is_boolean());
  }
  for (const char* key : {"returns", "closures"}) {
    if (row.contains(key)) require(key, row.at(key).is_array());
  }
  for (const char* key : {"end", "wall"}) {
    if (row.contains(key)) require(key, row.at(key).is_object());
  }
}

/// The keys that others read from a manifest. Seeds are missing in those of earlier versions.
void check_manifest(const std::string& file, const Json& manifest) {
  const auto require = [&](const char* key, bool right, const char* expected) {
    if (right) return;
    const std::string found = manifest.contains(key) ? "is " + manifest.at(key).dump().substr(0, 60) : "is missing";
    throw core::InputError(file + ": \"" + key + "\" " + found + ", expected " + expected);
  };
  for (const char* key : {"version", "commit", "scenario"}) {
    require(key, manifest.contains(key) && manifest.at(key).is_string(), "a text");
  }
  require("config", manifest.contains("config") && manifest.at("config").is_array(), "a list of lines");
  const Json seeds = manifest.value("seeds", Json::array());
  const auto is_range = [](const Json& range) {
    return range.is_array() && range.size() == 2 && range[0].is_number_unsigned() && range[1].is_number_unsigned() &&
           range[0].get<std::uint64_t>() <= range[1].get<std::uint64_t>();
  };
  require("seeds", seeds.is_array() && std::all_of(seeds.begin(), seeds.end(), is_range),
          "pairs of a first and a last seed");
}

}  // namespace

Json campaign_manifest(const std::string& folder) {
  const std::string file = folder + '/' + manifest_name;
  const std::string text = files::read_whole_file(file);
  files::check_json_nesting(file, text);
  Json manifest = Json::parse(text, nullptr, false);
  if (!manifest.is_object() || manifest.value("format", Json()) != campaign_format) {
    throw core::InputError(file + ": not the manifest of a campaign; choose another folder");
  }
  check_manifest(file, manifest);
  return manifest;
}

std::vector<Json> campaign_rows(const std::string& folder) {
  const std::string file = folder + '/' + rows_name;
  const std::string text = files::read_whole_file(file);
  files::check_json_nesting(file, text);
  std::vector<Json> rows;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; begin = end + 1, end = text.find('\n', begin)) {
    const auto first = text.begin() + static_cast<std::ptrdiff_t>(begin);
    Json row = Json::parse(first, text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    check_row(file, rows.size() + 1, row);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string text_of_rows(const std::vector<Json>& rows) {
  std::string text;
  for (const Json& row : rows) text += row.dump() + '\n';
  return text;
}

void sort_by_seed(std::vector<Json>& rows) {
  std::sort(rows.begin(), rows.end(), [](const Json& a, const Json& b) {
    return a.at("seed").get<std::uint64_t>() < b.at("seed").get<std::uint64_t>();
  });
}

std::string first_difference(const Json& held, const Json& wanted) {
  for (const char* key : {"format", "version", "commit", "scenario"}) {
    if (held.value(key, Json()) != wanted.at(key)) {
      return std::string(key) + " " + held.value(key, Json()).dump() + ", now " + wanted.at(key).dump();
    }
  }
  const Json lines = held.value("config", Json::array());
  for (std::size_t i = 0; i < std::max(lines.size(), wanted.at("config").size()); ++i) {
    const Json was = i < lines.size() ? lines[i] : Json();
    const Json is = i < wanted.at("config").size() ? wanted.at("config")[i] : Json();
    if (was != is) return was.dump() + ", now " + is.dump();
  }
  return {};
}

SeedRanges seed_ranges(const Json& manifest) {
  SeedRanges ranges;
  for (const Json& range : manifest.value("seeds", Json::array())) {
    ranges.emplace_back(range[0].get<std::uint64_t>(), range[1].get<std::uint64_t>());
  }
  return ranges;
}

SeedRanges fused(SeedRanges ranges) {
  std::sort(ranges.begin(), ranges.end());
  SeedRanges whole;
  for (const auto& [first, last] : ranges) {
    if (!whole.empty() && first <= whole.back().second + 1) {
      whole.back().second = std::max(whole.back().second, last);
    } else {
      whole.emplace_back(first, last);
    }
  }
  return whole;
}

void check_no_seed_between_is_missing(const SeedRanges& fused) {
  std::string missing;
  for (std::size_t i = 1; i < fused.size(); ++i) {
    const std::uint64_t first = fused[i - 1].second + 1, last = fused[i].first - 1;
    missing += (missing.empty() ? "" : ", ") + std::to_string(first);
    if (last > first) missing += " to " + std::to_string(last);
  }
  if (missing.empty()) return;
  throw core::InputError("seeds " + missing +
                         " are in none of the parts; drive them, too, or give the part that has them");
}

}  // namespace helixnav::apps
