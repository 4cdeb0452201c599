// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/map_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "tables/map_text.hpp"
#include "tables/run_tables.hpp"

namespace helixnav::runs {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view drives_header = "sha256";

bool is_digest(const std::string& text) {
  constexpr std::size_t digits = 64;
  return text.size() == digits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

std::vector<core::MapLandmark> landmarks_of(const core::JointMap& map) {
  std::vector<core::MapLandmark> landmarks(map.joint.ids.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    landmarks[i].id = map.joint.ids[i];
    landmarks[i].point = {map.joint.points_m[i], map.covariance_m2_of(i)};
    landmarks[i].observations = map.observations[i];
    landmarks[i].state = map.states[i];
    if (!map.appearances.empty()) landmarks[i].appearance = map.appearances[i];
  }
  return landmarks;
}

void write_map(const std::string& folder, const core::JointMap& map,
               const std::map<core::LandmarkId, std::string>& names) {
  const std::vector<core::MapLandmark> landmarks = landmarks_of(map);
  files::write_whole_file(folder + '/' + std::string(map_table.file), map_text(landmarks, names));
  write_joint_map(folder, map);
  const std::string joined_from = folder + '/' + joined_from_file;
  std::error_code none;
  if (map.has_end) {
    fs::remove(joined_from, none);  // from a map that was there before
  } else {
    files::write_whole_file(joined_from, joined_from_header);
  }
}

void write_joint_map(const std::string& folder, const core::JointMap& map) {
  if (map.factors == nullptr && map.joint.ids.size() > most_joint_landmarks) return;
  files::write_whole_file(folder + '/' + joint_map_file, [&map](files::AppendFile& file) {
    put_joint_map(map, [&file](std::string_view block) { file.append(block); });
  });
  const std::string drives = folder + '/' + drives_file;
  std::error_code none;
  if (map.drives.empty()) {
    fs::remove(drives, none);  // from a map that was there before
    return;
  }
  std::string text = std::string(drives_header) + '\n';
  for (const std::string& drive : map.drives) text += drive + '\n';
  files::write_whole_file(drives, text);
}

std::vector<std::string> read_drives(const std::string& folder) {
  const std::string path = folder + '/' + drives_file;
  if (!fs::exists(path)) return {};
  std::istringstream lines(files::read_whole_file(path));
  std::string line;
  std::vector<std::string> drives;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const bool fits = number == 1 ? line == drives_header : is_digest(line);
    if (!fits) {
      throw core::InputError(path + ':' + std::to_string(number) + ": expected " +
                             (number == 1 ? "the header line \"" + std::string(drives_header) + '"'
                                          : std::string("a SHA-256 of 64 hexadecimal digits")));
    }
    if (number > 1) drives.push_back(line);
  }
  std::sort(drives.begin(), drives.end());
  return drives;
}

}  // namespace helixnav::runs
