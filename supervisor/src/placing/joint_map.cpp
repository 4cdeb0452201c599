// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/joint_map.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "placing/names_of_factors.hpp"
#include "window/marginals.hpp"

namespace helixnav::supervisor {

void check_has_end(const core::JointMap& map) {
  if (map.has_end) return;
  throw core::PreconditionError(
      "a joined map has no end, since each of its sessions ended elsewhere; look for the place on it, or give a pose");
}

std::vector<core::LandmarkId> ids_of(const std::vector<core::MapLandmark>& landmarks) {
  std::vector<core::LandmarkId> ids;
  for (const core::MapLandmark& landmark : landmarks) ids.push_back(landmark.id);
  return ids;
}

void keep_names(const std::vector<core::LandmarkId>& ids, core::MapFactors& factors) {
  const auto is_other = [&](const auto& named) { return !std::binary_search(ids.begin(), ids.end(), named.first); };
  factors.landmarks.erase(std::remove_if(factors.landmarks.begin(), factors.landmarks.end(), is_other),
                          factors.landmarks.end());
}

namespace {

core::JointMap without_joint(core::LandmarkId next_name, const std::vector<core::MapLandmark>& landmarks) {
  core::JointMap map;
  for (const core::MapLandmark& landmark : landmarks) {
    map.states.push_back(landmark.state);
    map.observations.push_back(landmark.observations);
  }
  const auto is_given = [](const core::MapLandmark& landmark) { return landmark.appearance.is_given(); };
  if (std::any_of(landmarks.begin(), landmarks.end(), is_given)) {
    for (const core::MapLandmark& landmark : landmarks) map.appearances.push_back(landmark.appearance);
  }
  map.next_name = next_name;
  return map;
}

}  // namespace

core::JointMap joint_map(core::JointGaussian joint, core::LandmarkId next_name,
                         const std::vector<core::MapLandmark>& landmarks) {
  core::JointMap map = without_joint(next_name, landmarks);
  map.joint = std::move(joint);
  return map;
}

core::JointMap factored_map(core::MapFactors factors, const core::PoseGaussian& pose, core::LandmarkId next_name,
                            const std::vector<core::MapLandmark>& landmarks) {
  core::JointMap map = without_joint(next_name, landmarks);
  map.joint.pose = pose.mean;
  map.joint.covariance = pose.covariance;
  map.joint.ids = ids_of(landmarks);
  keep_names(map.joint.ids, factors);
  map.factors = std::make_shared<const core::MapFactors>(std::move(factors));
  for (const core::MapLandmark& landmark : landmarks) {
    map.joint.points_m.push_back(landmark.point.mean_m);
    map.covariances_m2.push_back(landmark.point.covariance_m2);
  }
  return map;
}

core::JointMap factored_map(const atlas::Atlas& drive, core::LandmarkId next_name,
                            const std::vector<core::MapLandmark>& landmarks, FactoredMap how) {
  const core::JointGaussian end = drive.joint({});
  core::JointMap map = factored_map(drive.factors(), {end.pose, end.covariance}, next_name, landmarks);
  if (how == FactoredMap::factors_alone) return map;
  const std::vector<core::PointGaussian> solved = marginals_of(drive, map.joint.ids);
  for (std::size_t i = 0; i < solved.size(); ++i) {
    const Eigen::Matrix2d& covariance_m2 = solved[i].covariance_m2;
    map.joint.points_m[i] = solved[i].mean_m;
    map.covariances_m2[i] = 0.5 * (covariance_m2 + covariance_m2.transpose());
  }
  return map;
}

core::JointMap joint_map(const cekf::CompressedEkf& filter, const std::vector<core::MapLandmark>& landmarks) {
  return joint_map(filter.joint(ids_of(landmarks)), filter.next_name(), landmarks);
}

}  // namespace helixnav::supervisor
