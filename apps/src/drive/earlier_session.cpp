// SPDX-License-Identifier: BSD-3-Clause
#include "earlier_session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

#include "given_map.hpp"
#include "helixnav/atlas/atlas.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/runs/run_folder.hpp"

namespace helixnav::apps {
namespace {

constexpr double most_coordinate = 1e8;          ///< of a pose, as in logs and maps
constexpr std::ptrdiff_t least_to_be_found = 5;  ///< pairs for a place, see relocalize::ask

void check_size(const std::string& file, const EarlierSession& session) {
  const auto mature = std::count(session.map.states.begin(), session.map.states.end(), core::LandmarkState::mature);
  const bool unknown = session.start.kind == SessionStart::Kind::unknown;
  const std::ptrdiff_t least = unknown ? least_to_be_found : 1;
  if (mature >= least) return;
  throw core::InputError(file + ": the map holds " + std::to_string(mature) +
                         (mature == 1 ? " mature landmark" : " mature landmarks") + "; " +
                         (unknown
                              ? "a place on it can be found from " + std::to_string(least) + " on: give --start a pose"
                              : "there is nothing to go on in"));
}

/// map.bin says where landmarks are, map.csv beside it what they look like.
void tell_appearances(const std::vector<core::MapLandmark>& table, core::JointMap& map) {
  std::map<core::LandmarkId, core::LandmarkAppearance> known;
  for (const core::MapLandmark& landmark : table) {
    if (landmark.appearance.is_given()) known.emplace(landmark.id, landmark.appearance);
  }
  if (known.empty()) return;
  for (const core::LandmarkId id : map.joint.ids) {
    const auto found = known.find(id);
    map.appearances.push_back(found == known.end() ? core::LandmarkAppearance() : found->second);
  }
}

}  // namespace

SessionStart session_start_from(const std::string& word, std::string& objection) {
  SessionStart start;
  if (word == "unknown") return start;
  start.kind = SessionStart::Kind::end;
  if (word == "end") return start;
  start.kind = SessionStart::Kind::pose;
  std::array<double, 3> numbers{};
  std::string_view rest = word;
  bool fine = std::count(word.begin(), word.end(), ',') == 2;
  for (double& number : numbers) {
    const std::string_view cell = rest.substr(0, rest.find(','));
    const auto value = files::parse_number(cell);
    fine = fine && value && std::abs(*value) <= most_coordinate;
    number = value.value_or(0.0);
    rest.remove_prefix(std::min(cell.size() + 1, rest.size()));
  }
  if (!fine) {
    objection = "'" + word + "': expected unknown, end, or a pose x,y,heading in metres and radians, within 1e8";
    return {};
  }
  start.T_map_robot = core::Pose2(numbers[0], numbers[1], numbers[2]);
  return start;
}

std::string joint_map_file_in(const std::string& folder) {
  return (std::filesystem::path(folder) / "map.bin").string();
}

/// Why a run has no map.bin.
std::string why_without_map(const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path path = fs::absolute(fs::path(folder) / ".").lexically_normal().parent_path();
  const bool is_robot = path.filename().string().rfind("robot_", 0) == 0;
  if (fs::exists(path / "sightings.csv") || (is_robot && fs::exists(path.parent_path() / "sightings.csv"))) {
    return "The run of a team writes none: it cannot be gone on from nor joined with another run";
  }
  if (fs::exists(path / "particles.csv")) {
    return "A run of FastSLAM writes none: its map is that of its particles; it cannot be gone on from nor joined with "
           "another run";
  }
  return "A run that came to its end writes it, unless it only localised, is of version 0.1, or has more than " +
         std::to_string(runs::most_joint_landmarks) +
         " landmarks whose drive was not kept (it began in a map without factors, or its search was off)";
}

namespace {

void check_factors_of(const core::JointMap& map, const std::string& file) {
  if (map.factors == nullptr) return;
  try {
    atlas::check_factors(*map.factors);
  } catch (const core::PreconditionError& error) {
    throw core::InputError(file + ": " + error.what());
  }
}

}  // namespace

core::JointMap read_joint_map_in(const std::string& folder) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(folder)) {
    throw core::InputError(folder + ": expected the folder of a run with its map" +
                           (fs::exists(folder) ? ", found a file (a map.csv alone serves --localize only)" : ""));
  }
  const std::string file = joint_map_file_in(folder);
  if (!fs::exists(file)) {
    throw core::InputError(file + ": not there. " + why_without_map(folder));
  }
  core::JointMap map = runs::read_joint_map(file);
  check_factors_of(map, file);
  map.drives = runs::read_drives(folder);
  map.has_end =
      fs::exists(fs::path(folder) / "manifest.json") || !fs::exists(fs::path(folder) / runs::joined_from_file);
  const fs::path table = fs::path(folder) / "map.csv";
  if (fs::exists(table)) tell_appearances(runs::read_map(table.string()), map);
  return map;
}

void check_has_covariance(const core::JointMap& map, const std::string& name, const std::string& what) {
  if (map.has_covariance()) return;
  throw core::InputError(name + ": a map of " + std::to_string(map.joint.ids.size()) +
                         " landmarks is kept without a joint covariance, which " + what +
                         " needs; that is kept for up to " + std::to_string(runs::most_joint_landmarks) + " landmarks");
}

core::JointMap read_dense_map_in(const std::string& folder, const std::string& what) {
  core::JointMap map = read_joint_map_in(folder);
  check_has_covariance(map, joint_map_file_in(folder), what);
  return map;
}

EarlierSession earlier_session(core::JointMap map, const SessionStart& start, const std::string& name) {
  if (start.kind == SessionStart::Kind::end && !map.has_end) {
    throw core::InputError(name +
                           ": a joined map has no end, since each of its runs ended elsewhere; give --start unknown or "
                           "a pose x,y,heading");
  }
  EarlierSession session{std::move(map), {}, start, {}, {}, {}};
  check_size(name, session);
  return session;
}

EarlierSession read_earlier_session(const std::string& folder, const SessionStart& start) {
  EarlierSession session = earlier_session(read_joint_map_in(folder), start, joint_map_file_in(folder));
  if (!std::filesystem::exists(std::filesystem::path(folder) / "manifest.json")) return session;
  const std::vector<core::LandmarkId>& ids = session.map.joint.ids;
  const runs::Run run = runs::read_run(folder);
  session.missing = run.missing;
  if (!run.steps.empty()) session.ended_ns = run.steps.back().t_ns;
  session.T_truth_map = runs::T_truth_of_map(run);
  for (const auto& [label, id] : landmarks_by_label(run)) {
    if (std::binary_search(ids.begin(), ids.end(), id)) session.landmark_of[label] = id;
  }
  return session;
}

core::PoseGaussian given_start(const core::Pose2& T_map_robot, double reach_m) {
  const double sigma_m = reach_m / 60.0;
  constexpr double sigma_rad = 3.0 * core::pi / 180.0;
  return {T_map_robot, Eigen::Vector3d(sigma_m, sigma_m, sigma_rad).cwiseAbs2().asDiagonal()};
}

}  // namespace helixnav::apps
