// SPDX-License-Identifier: BSD-3-Clause
#include "given_map.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>

#include "helixnav/core/errors.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/lengths.hpp"

namespace helixnav::apps {
namespace {

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

void sort_by_id(std::vector<core::MapLandmark>& landmarks) {
  std::sort(landmarks.begin(), landmarks.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
}

/// Nothing if the map holds a landmark that `earlier` does not, or if that has no joint covariance.
Eigen::MatrixXd covariance_of(const std::vector<core::MapLandmark>& landmarks, const core::JointMap& earlier) {
  const core::JointGaussian& joint = earlier.joint;
  if (!earlier.has_covariance()) return {};
  std::vector<Eigen::Index> rows;
  for (const core::MapLandmark& landmark : landmarks) {
    const auto found = std::lower_bound(joint.ids.begin(), joint.ids.end(), landmark.id);
    if (found == joint.ids.end() || *found != landmark.id) return {};
    const auto row = 3 + 2 * static_cast<Eigen::Index>(found - joint.ids.begin());
    rows.insert(rows.end(), {row, row + 1});
  }
  return joint.covariance(rows, rows);
}

/// A large map with its factors alone; null if it has none. A small one is not drawn as factors.
std::shared_ptr<const core::JointMap> factors_alone(core::JointMap map) {
  const auto landmarks = static_cast<int>(map.joint.ids.size());
  if (map.factors == nullptr || landmarks <= supervisor::MapOptions{}.whole) return nullptr;
  if (map.has_covariance()) {
    for (std::size_t i = 0; i < map.joint.ids.size(); ++i) map.covariances_m2.push_back(map.covariance_m2_of(i));
    map.joint.covariance = map.joint.covariance.topLeftCorner<3, 3>().eval();
  }
  return std::make_shared<const core::JointMap>(std::move(map));
}

/// A map made by no single run, such as one from join: map.bin beside map.csv holds the same landmarks.
void tell_missing_landmarks(const std::filesystem::path& table, const std::filesystem::path& whole, std::size_t found,
                            std::vector<std::string>& missing) {
  if (table.filename() != "map.csv" || !std::filesystem::exists(whole)) return;
  const std::size_t expected = runs::read_joint_map(whole.string()).joint.ids.size();
  if (found >= expected) return;
  missing.push_back(table.string() + ": " + std::to_string(found) + " of the " + std::to_string(expected) +
                    " landmarks that map.bin beside it has: the file was cut since");
}

}  // namespace

std::map<core::Label, core::LandmarkId> landmarks_by_label(const runs::Run& run) {
  std::set<core::LandmarkId> kept;  // a landmark that was moved is begun anew, and the old one is in no map
  for (const core::MapLandmark& landmark : run.map) kept.insert(landmark.id);
  std::map<core::Label, std::map<core::LandmarkId, int>> votes;
  for (std::size_t k = 0; k < std::min(run.steps.size(), run.truth.labels.size()); ++k) {
    const std::vector<core::Label>& labels = run.truth.labels[k];
    for (const core::AssociationReport& a : run.steps[k].associations) {
      const auto observation = static_cast<std::size_t>(a.observation);
      const bool settled = (a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented) &&
                           (kept.empty() || kept.count(a.landmark) > 0);
      if (settled && observation < labels.size() && labels[observation] >= 0) ++votes[labels[observation]][a.landmark];
    }
  }
  std::map<core::Label, core::LandmarkId> landmark_of;
  for (const auto& [label, counts] : votes) {
    const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
    landmark_of[label] = std::max_element(counts.begin(), counts.end(), fewer)->first;
  }
  return landmark_of;
}

bool can_be_searched(const GivenMap& map) {
  constexpr std::size_t least_searched = 5;
  const bool is_small = map.landmarks.size() <= runs::most_joint_landmarks;
  return map.landmarks.size() >= least_searched && (is_small || map.large != nullptr);
}

namespace {

/// Without those that are not among the landmarks.
core::JointMap with_these_alone(core::JointMap map, const std::vector<core::MapLandmark>& landmarks) {
  auto given = landmarks.begin();
  for (std::size_t i = 0; i < map.joint.ids.size(); ++i) {
    while (given != landmarks.end() && given->id < map.joint.ids[i]) ++given;
    const bool is_given = given != landmarks.end() && given->id == map.joint.ids[i];
    if (!is_given) map.states[i] = core::LandmarkState::tentative;
  }
  return map;
}

core::JointMap with_covariance(const GivenMap& map) {
  core::JointMap given;
  const auto rows = static_cast<Eigen::Index>(2 * map.landmarks.size());
  given.joint.covariance = Eigen::MatrixXd::Zero(3 + rows, 3 + rows);
  if (map.covariance_m2.rows() == rows) given.joint.covariance.bottomRightCorner(rows, rows) = map.covariance_m2;
  for (const core::MapLandmark& landmark : map.landmarks) {
    given.joint.ids.push_back(landmark.id);
    given.joint.points_m.push_back(landmark.point.mean_m);
    given.states.push_back(core::LandmarkState::mature);
    given.observations.push_back(landmark.observations);
    given.appearances.push_back(landmark.appearance);
    given.next_name = landmark.id + 1;
  }
  return given;
}

}  // namespace

core::JointMap as_drawn(const GivenMap& map, const supervisor::NavigatorOptions& options,
                        const core::FieldOfView& view) {
  const core::JointMap given = map.large ? with_these_alone(*map.large, map.landmarks) : with_covariance(map);
  const double reach_m = view.reach().value_or(supervisor::reference_reach_m);
  const double pair_noise_m = supervisor::fit_lengths(options, view).search.constellation.branch_sigma_m;
  return supervisor::as_drawn(given, reach_m, pair_noise_m);
}

void check_start(const GivenMap& map) {
  if (!map.start || map.start->kind != SessionStart::Kind::unknown || can_be_searched(map)) return;
  throw core::InputError("--start unknown: a map of " + std::to_string(map.landmarks.size()) +
                         " landmarks cannot be searched; expected 5 to " + std::to_string(runs::most_joint_landmarks) +
                         ", or the folder of a run that left a larger one: give a pose");
}

std::string map_file(const std::string& path) {
  return std::filesystem::is_directory(path) ? (std::filesystem::path(path) / "map.csv").string() : path;
}

GivenMap given_map(const core::JointMap& map) {
  GivenMap given;
  for (const core::MapLandmark& landmark : runs::landmarks_of(map)) {
    if (landmark.state == core::LandmarkState::mature) given.landmarks.push_back(landmark);
  }
  if (given.landmarks.empty()) throw core::InputError("map: expected mature landmarks, found none");
  sort_by_id(given.landmarks);
  given.covariance_m2 = covariance_of(given.landmarks, map);
  given.large = factors_alone(map);
  return given;
}

GivenMap read_given_map(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path file = map_file(path);
  if (!fs::exists(file)) {
    throw core::InputError(path + ": expected a map.csv, or the folder of a run that came to its end");
  }
  GivenMap map;
  std::set<core::LandmarkId> ids;
  const std::vector<core::MapLandmark> rows = runs::read_map(file.string());
  for (const core::MapLandmark& landmark : rows) {
    if (landmark.state != core::LandmarkState::mature) continue;
    if (!ids.insert(landmark.id).second) {
      throw core::InputError(file.string() + ": landmark " + std::to_string(landmark.id) + " is there twice");
    }
    map.landmarks.push_back(landmark);
  }
  if (map.landmarks.empty()) throw core::InputError(file.string() + ": expected mature landmarks, found none");
  sort_by_id(map.landmarks);
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (file.filename() == "map.csv" && fs::exists(folder / "map.bin")) {
    core::JointMap whole = read_joint_map_in(folder.string());
    map.covariance_m2 = covariance_of(map.landmarks, whole);
    map.large = factors_alone(std::move(whole));
  }
  if (!fs::exists(folder / "manifest.json")) {
    tell_missing_landmarks(file, folder / "map.bin", rows.size(), map.missing);
    return map;
  }
  const runs::Run run = runs::read_run(folder.string());
  map.missing = run.missing;
  map.T_truth_map = runs::T_truth_of_map(run);
  for (const auto& [label, id] : landmarks_by_label(run)) {
    if (ids.count(id) > 0) map.landmark_of[label] = id;
  }
  return map;
}

void LabelAgreement::count(const core::StepReport& report, const std::vector<core::Label>& labels,
                           const GivenMap& map) {
  for (const core::AssociationReport& a : report.associations) {
    const auto known = map.landmark_of.find(labels[static_cast<std::size_t>(a.observation)]);
    const bool is_on_map = known != map.landmark_of.end();
    const bool is_matched = a.outcome == core::Outcome::matched;
    on_map += is_on_map ? 1 : 0;
    matched += is_matched ? 1 : 0;
    right += is_matched && is_on_map && known->second == a.landmark ? 1 : 0;
  }
}

std::string text_of(const LabelAgreement& agreement) {
  if (agreement.on_map == 0) return {};
  char text[256];
  std::snprintf(text, sizeof text,
                "association          precision %.4f (%zu of %zu matches), recall %.4f (%zu observations of the map)\n",
                ratio(agreement.right, agreement.matched), agreement.right, agreement.matched,
                ratio(agreement.right, agreement.on_map), agreement.on_map);
  return text;
}

std::vector<std::pair<std::string, double>> numbers_of(const LabelAgreement& agreement) {
  if (agreement.on_map == 0) return {};
  return {{"association.matched", static_cast<double>(agreement.matched)},
          {"association.right", static_cast<double>(agreement.right)},
          {"association.on_map", static_cast<double>(agreement.on_map)},
          {"association.precision", ratio(agreement.right, agreement.matched)},
          {"association.recall", ratio(agreement.right, agreement.on_map)}};
}

}  // namespace helixnav::apps
