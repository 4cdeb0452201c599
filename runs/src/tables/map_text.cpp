// SPDX-License-Identifier: BSD-3-Clause
#include "map_text.hpp"

#include <algorithm>

#include "appearance_cells.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/runs/words.hpp"
#include "run_tables.hpp"

namespace helixnav::runs {

namespace {

void append_name(std::string& text, const std::map<core::LandmarkId, std::string>& names, core::LandmarkId id) {
  text += ',';
  const auto found = names.find(id);
  if (found == names.end()) return;
  for (const char c : found->second) {
    const bool is_plain = c != ',' && c != '"' && (static_cast<unsigned char>(c) >= ' ') && c != '\x7f';
    text += is_plain ? c : ' ';
  }
}

}  // namespace

std::string map_text(const std::vector<core::MapLandmark>& map, const std::map<core::LandmarkId, std::string>& names) {
  const bool tells_appearance = std::any_of(
      map.begin(), map.end(), [](const core::MapLandmark& landmark) { return landmark.appearance.is_given(); });
  std::string text(tells_appearance ? map_table_with_appearance.header : map_table.header);
  text += names.empty() ? "\n" : ",name\n";
  for (const core::MapLandmark& landmark : map) {
    const Eigen::Matrix2d& P = landmark.point.covariance_m2;
    files::append_number(text, std::int64_t{landmark.id});
    for (const double value : {landmark.point.mean_m.x(), landmark.point.mean_m.y(), P(0, 0), P(0, 1), P(1, 1)}) {
      text += ',';
      files::append_number(text, value);
    }
    text += ',';
    files::append_number(text, std::int64_t{landmark.observations});
    text += ',';
    text += word_of(state_words, landmark.state);
    if (tells_appearance) append_appearance(text, landmark.appearance);
    if (!names.empty()) append_name(text, names, landmark.id);
    text += '\n';
  }
  return text;
}

}  // namespace helixnav::runs
