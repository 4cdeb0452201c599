// SPDX-License-Identifier: BSD-3-Clause
// Going on in the map of an earlier run.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "map_builder_impl.hpp"
#include "navigator_estimator.hpp"
#include "navigator_options.hpp"
#include "pose_pdf.hpp"

namespace helixnav::mrpt_adapter {
namespace {

namespace fs = std::filesystem;

constexpr const char* map_file = "map.bin";
constexpr std::ptrdiff_t least_to_be_found = 5;  ///< pairs of a place, see relocalize::ask

void check_that_maps_go_on(const MapBuilderOptions& options) {
  if (options.filter != "fastslam") return;
  throw core::PreconditionError("FastSLAM (filter = fastslam) does not go on in earlier maps");
}

core::JointMap read_map(const fs::path& path, bool unknown_start) {
  const std::string file = (fs::is_directory(path) ? path / map_file : path).string();
  core::JointMap map = runs::read_joint_map(file);
  const auto mature = std::count(map.states.begin(), map.states.end(), core::LandmarkState::mature);
  const std::ptrdiff_t least = unknown_start ? least_to_be_found : 1;
  if (mature >= least) return map;
  throw core::InputError(file + ": the map has " + std::to_string(mature) + " mature landmarks, and " +
                         std::to_string(least) + " are needed" +
                         (unknown_start ? " to find the place on it: give a pose" : ""));
}

core::JointMap with_pose(core::JointMap map, const core::PoseGaussian& pose) {
  core::check_start(pose);
  return supervisor::begun_at(std::move(map), pose);
}

}  // namespace

void MapBuilder::Impl::go_on_in(const core::JointMap& earlier, const std::optional<core::PoseGaussian>& pose) {
  const supervisor::NavigatorOptions settings = navigator_options(options);
  if (pose) {
    restart(std::make_unique<NavigatorEstimator>(with_pose(earlier, *pose), NavigatorEstimator::Names{}, settings));
  } else {
    restart(NavigatorEstimator::looking_for_place_in(earlier, settings));
  }
  association_ = Association::unknown;
  reach_m_ = earlier.reach_m;
}

void MapBuilder::Impl::set_pose(const core::PoseGaussian& pose) {
  const std::optional<core::JointMap> sought = navigator->sought_in();
  if (sought) return go_on_in(*sought, pose);
  const std::map<core::LandmarkId, std::int64_t> name_of = name_of_;
  NavigatorEstimator::Names names;
  for (const auto& [landmark, name] : name_of) names[name] = landmark;
  const core::JointMap map = with_pose(joint_map(), pose);
  if (map.joint.ids.empty()) return start_at(pose);
  const Association association = association_;
  const double reach_m = reach_m_;
  restart(std::make_unique<NavigatorEstimator>(map, names, navigator_options(options)));
  association_ = association;
  name_of_ = name_of;
  reach_m_ = reach_m;
}

void MapBuilder::Impl::lose() {
  navigator->lose();
  association_ = Association::unknown;
  part_begin_ = path.size();
}

/// The path since the vehicle was lost, in the frame of the map on which it was found.
void MapBuilder::Impl::place_path(const core::StepReport& report) {
  for (const core::Decision& decision : report.decisions) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    if (placed == nullptr || placed->verdict != core::PlacedDecision::Verdict::accepted) continue;
    for (std::size_t k = part_begin_; k < path.size(); ++k) path[k] = core::compose(placed->T_map_session, path[k]);
  }
}

core::JointMap MapBuilder::Impl::joint_map() const {
  core::JointMap map = navigator->joint_map();
  map.reach_m = reach_m_;
  return map;
}

void MapBuilder::initializeFromRun(const std::string& runFolder, const mrpt::poses::CPosePDF* x0) {
  check_that_maps_go_on(impl_->options);
  const core::JointMap map = read_map(runFolder, x0 == nullptr);
  const std::optional<core::PoseGaussian> pose = x0 != nullptr ? std::optional(gaussian_of(*x0)) : std::nullopt;
  const Impl::Lock lock(impl_->lock);
  impl_->go_on_in(map, pose);
}

void MapBuilder::loadCurrentMapFromFile(const std::string& fileName) {
  const fs::path path(fileName);
  if (fs::is_directory(path) || path.filename() == map_file) return initializeFromRun(fileName);
  if (!fileName.empty() && !fs::exists(path)) {  // MRPT begins with an empty map, which knows where the vehicle is
    throw core::InputError(fileName + ": there is no such run folder or file");
  }
  CMetricMapBuilder::loadCurrentMapFromFile(fileName);
}

void MapBuilder::setInitialPose(const mrpt::poses::CPosePDF& x0) {
  check_that_maps_go_on(impl_->options);
  const core::PoseGaussian pose = gaussian_of(x0);
  const Impl::Lock lock(impl_->lock);
  impl_->set_pose(pose);
}

void MapBuilder::relocalize() {
  check_that_maps_go_on(impl_->options);
  const Impl::Lock lock(impl_->lock);
  impl_->lose();
}

bool MapBuilder::isPlaceKnown() const {
  const Impl::Lock lock(impl_->lock);
  return impl_->navigator->place_is_known();
}

void MapBuilder::saveMapToFolder(const std::string& folder) const {
  check_that_maps_go_on(impl_->options);
  core::JointMap map;
  {
    const Impl::Lock lock(impl_->lock);
    map = impl_->joint_map();
  }
  if (map.factors == nullptr && map.joint.ids.size() > runs::most_joint_landmarks) {
    throw core::InputError(folder + ": a map of " + std::to_string(map.joint.ids.size()) +
                           " landmarks is too large to be saved with its covariance");
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw core::InputError(folder + ": cannot make the folder: " + error.message());
  runs::write_map(folder, map);
}

}  // namespace helixnav::mrpt_adapter
