// SPDX-License-Identifier: BSD-3-Clause
// Questions about the whole map of landmarks known by name, of which the filter may hold a part.
#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "named/named_drive.hpp"
#include "window/marginals.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

/// The drive in the atlas, up to now and solved.
NamedDrive solved(NamedDrive drive, double reach_m) {
  drive.settle(phase_length_m(reach_m), nullptr);
  return drive;
}

}  // namespace

template <class PointOf>
std::vector<core::MapLandmark> NamedNavigator::map_with(const PointOf& point_of) const {
  std::vector<core::MapLandmark> landmarks;
  landmarks.reserve(observations_.size());
  for (const auto& [id, observations] : observations_) {
    if (integrity_.is_superseded(id)) continue;
    core::MapLandmark landmark;
    landmark.id = id;
    landmark.point = point_of(id);
    landmark.observations = observations;
    landmark.state = core::LandmarkState::mature;
    landmarks.push_back(landmark);
  }
  return landmarks;
}

std::vector<core::MapLandmark> NamedNavigator::map() const {
  if (!names_.is_part) return map_with([this](LandmarkId id) { return filter_.landmark(id); });
  const NamedDrive drive = solved(*drive_, reach_m_);
  std::vector<LandmarkId> ids;
  for (const auto& [id, observations] : observations_) {
    if (!integrity_.is_superseded(id)) ids.push_back(id);
  }
  const std::vector<core::PointGaussian> points = marginals_of(drive.atlas(), ids);
  std::size_t at = 0;
  return map_with([&](LandmarkId) { return points[at++]; });
}

std::vector<core::MapLandmark> NamedNavigator::sketch() const {
  if (!names_.is_part) return map();
  const std::vector<atlas::Place> places = drive_->atlas().landmarks();
  auto place = places.begin();
  return map_with([&](LandmarkId id) {
    while (place != places.end() && place->id < id) ++place;
    const LandmarkId name = names_.in_filter(id);
    if (name != core::no_landmark) return filter_.landmark(name);
    return core::PointGaussian{place->point_m, remembered_m2_[static_cast<std::size_t>(id)]};
  });
}

core::JointGaussian NamedNavigator::joint(const std::vector<LandmarkId>& ids) const {
  std::vector<LandmarkId> names;
  for (const LandmarkId id : ids) names.push_back(names_.in_filter(id));
  const bool is_held =
      std::all_of(names.begin(), names.end(), [this](LandmarkId name) { return filter_.contains(name); });
  if (names_.is_part && !is_held) return solved(*drive_, reach_m_).atlas().joint(ids);
  core::JointGaussian joint = filter_.joint(names);
  joint.ids = ids;
  return joint;
}

std::optional<core::JointMap> NamedNavigator::factored_map(FactoredMap how) const {
  if (!names_.is_part) return std::nullopt;
  const std::vector<core::MapLandmark> landmarks = sketch();
  const LandmarkId next_name = landmarks.empty() ? 0 : landmarks.back().id + 1;
  return supervisor::factored_map(solved(*drive_, reach_m_).atlas(), next_name, landmarks, how);
}

}  // namespace helixnav::supervisor
