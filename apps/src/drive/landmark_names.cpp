// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_names.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>

#include "given_map.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/runs/run_folder.hpp"

namespace helixnav::apps {
namespace {

std::string name_of_label(const core::Recording& recording, core::Label label) {
  const auto index = static_cast<std::size_t>(label);
  return index < recording.label_names.size() ? recording.label_names[index] : std::to_string(label);
}

std::map<std::string, core::Label> label_of_names(const core::Recording& recording) {
  std::map<std::string, core::Label> label_of;
  for (std::size_t i = 0; i < recording.label_names.size(); ++i)
    label_of.emplace(recording.label_names[i], static_cast<core::Label>(i));
  return label_of;
}

}  // namespace

void number_by_names(const std::map<core::LandmarkId, std::string>& names_of_map, core::Recording& recording,
                     std::map<core::Label, core::LandmarkId>& landmark_of) {
  if (names_of_map.empty() || recording.label_names.empty()) return;
  std::map<std::string, core::Label> label_of = label_of_names(recording);
  std::map<core::Label, core::LandmarkId> anew;
  for (const auto& [label, id] : landmark_of) {
    const auto name = names_of_map.find(id);
    if (name == names_of_map.end()) continue;
    const auto [known, is_new] = label_of.emplace(name->second, static_cast<core::Label>(recording.label_names.size()));
    if (is_new) recording.label_names.push_back(name->second);
    anew[known->second] = id;
  }
  landmark_of = std::move(anew);
}

std::map<core::Label, core::LandmarkId> landmarks_by_name(const std::map<core::LandmarkId, std::string>& names_of_map,
                                                          const core::Recording& recording) {
  std::map<core::Label, core::LandmarkId> landmark_of;
  for (const auto& [id, name] : names_of_map) {
    if (!recording.label_names.empty()) {
      landmark_of.emplace(static_cast<core::Label>(landmark_of.size()), id);
    } else if (const auto label = files::parse_integer(name)) {
      landmark_of.emplace(static_cast<core::Label>(*label), id);
    }
  }
  return landmark_of;
}

void call_as_log(const std::string& map, const std::vector<core::LandmarkId>& ids, core::Recording& recording,
                 std::map<core::Label, core::LandmarkId>& landmark_of) {
  const std::string table = map_file(map);
  if (!std::filesystem::exists(table)) return;
  std::map<core::LandmarkId, std::string> names;
  for (auto& [id, name] : runs::read_landmark_names(table)) {
    if (std::binary_search(ids.begin(), ids.end(), id)) names.emplace(id, std::move(name));
  }
  const bool are_numbers_of_words = names.empty() && !recording.label_names.empty();  // another log's, in its order
  if (are_numbers_of_words) landmark_of.clear();
  if (landmark_of.empty()) landmark_of = landmarks_by_name(names, recording);
  number_by_names(names, recording, landmark_of);
}

std::map<core::LandmarkId, std::string> landmark_names(const Drive& job, const runs::Run& run) {
  std::map<core::LandmarkId, std::string> names;
  if (!job.known_association || job.fastslam.chosen) return names;
  if (job.earlier) {
    for (const auto& [label, id] : job.earlier->landmark_of) names[id] = name_of_label(job.recording, label);
  }
  if (job.given_map) {
    for (const auto& [label, id] : job.given_map->landmark_of) names[id] = name_of_label(job.recording, label);
  }
  for (const auto& [label, id] : landmarks_by_label(run)) names[id] = name_of_label(job.recording, label);
  return names;
}

}  // namespace helixnav::apps
