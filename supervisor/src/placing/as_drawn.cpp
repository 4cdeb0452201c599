// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "helixnav/supervisor/joint_map.hpp"
#include "placing/earlier_map.hpp"

namespace helixnav::supervisor {
namespace {

using core::MapFactors;

Eigen::MatrixXd blocks_of(const std::vector<core::PointGaussian>& points) {
  const auto rows = static_cast<Eigen::Index>(3 + 2 * points.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows, rows);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    covariance.block<2, 2>(row, row) = points[i].covariance_m2;
  }
  return covariance;
}

/// Points relative to the frame of the map, each by itself, and a pose that nothing depends on.
std::shared_ptr<const core::RelativeGaussian> information_on(const std::vector<core::PointGaussian>& points) {
  auto gaussian = std::make_shared<core::RelativeGaussian>();
  const auto rows = static_cast<Eigen::Index>(3 + 2 * points.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(rows, rows);
  information.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity();
  gaussian->vector = Eigen::VectorXd::Zero(rows);
  gaussian->mean = Eigen::VectorXd::Zero(rows);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    information.block<2, 2>(row, row) = points[i].covariance_m2.inverse();
    gaussian->mean.segment<2>(row) = points[i].mean_m;
  }
  gaussian->information = information;
  return gaussian;
}

/// Some landmarks at a time, as phases of a drive that never left the origin.
std::shared_ptr<const MapFactors> factors_of(const std::vector<core::LandmarkId>& ids,
                                             const std::vector<core::PointGaussian>& points) {
  constexpr std::size_t at_once = 20;
  auto map = std::make_shared<MapFactors>();
  map->world = 0;
  map->poses = {0};
  map->variables.push_back({3, Eigen::Vector3d::Zero()});
  for (std::size_t begin = 0; begin < ids.size(); begin += at_once) {
    const std::size_t end = std::min(ids.size(), begin + at_once);
    const int entry = map->poses.back();
    const int exit = static_cast<int>(map->variables.size());
    map->poses.push_back(exit);
    map->variables.push_back({3, Eigen::Vector3d::Zero()});
    MapFactors::Part seen{{map->world, exit}, nullptr, {}};
    for (std::size_t i = begin; i < end; ++i) {
      seen.variables.push_back(static_cast<int>(map->variables.size()));
      map->landmarks.emplace_back(ids[i], seen.variables.back());
      map->variables.push_back({2, Eigen::Vector3d(points[i].mean_m.x(), points[i].mean_m.y(), 0.0)});
    }
    const auto from = points.begin() + static_cast<std::ptrdiff_t>(begin);
    seen.gaussian = information_on({from, points.begin() + static_cast<std::ptrdiff_t>(end)});
    MapFactors::Phase& phase = map->phases.emplace_back();
    phase.parts.push_back({{entry, exit}, information_on({}), {}});
    phase.parts.push_back(std::move(seen));
  }
  return map;
}

}  // namespace

core::JointMap as_drawn(const core::JointMap& map, double reach_m, double pair_noise_m) {
  const EarlierMap earlier(map);
  core::JointMap drawn;
  drawn.joint.ids = earlier.landmarks().ids;
  std::vector<core::PointGaussian> points = earlier.relative_to_neighbours(reach_m);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].covariance_m2 += 0.5 * pair_noise_m * pair_noise_m * Eigen::Matrix2d::Identity();
    drawn.joint.points_m.push_back(points[i].mean_m);
    drawn.states.push_back(core::LandmarkState::mature);
    drawn.observations.push_back(earlier.observations(i));
    if (!map.appearances.empty()) drawn.appearances.push_back(earlier.appearance().of(drawn.joint.ids[i]));
  }
  drawn.next_name = map.next_name;
  drawn.reach_m = map.reach_m;
  if (map.has_covariance()) {
    drawn.joint.covariance = blocks_of(points);
    return drawn;
  }
  drawn.joint.covariance = Eigen::Matrix3d::Zero();
  for (const core::PointGaussian& point : points) drawn.covariances_m2.push_back(point.covariance_m2);
  drawn.factors = factors_of(drawn.joint.ids, points);
  return drawn;
}

}  // namespace helixnav::supervisor
