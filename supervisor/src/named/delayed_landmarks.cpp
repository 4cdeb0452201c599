// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/delayed_landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "named/fit_point.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using Index = Eigen::Index;

LandmarkId clone(cekf::CompressedEkf& filter, const Eigen::Vector2d& point_robot_m, double clone_sigma_m) {
  return filter.augment(
      core::make_cartesian(point_robot_m, clone_sigma_m * clone_sigma_m * Eigen::Matrix2d::Identity()), {});
}

/// Points of the map in the frame of the robot, with their derivative by (pose, points) and their covariance.
struct RelativePoints {
  std::vector<Eigen::Vector2d> points_m;
  Eigen::MatrixXd J;
  Eigen::MatrixXd P;
};

RelativePoints relative_points(const core::JointGaussian& joint) {
  RelativePoints relative;
  const auto n = static_cast<Index>(joint.ids.size());
  const Eigen::Matrix2d R_robot_world = core::rotation(joint.pose.heading_rad).transpose();
  relative.J.setZero(2 * n, 3 + 2 * n);
  for (Index i = 0; i < n; ++i) {
    const Eigen::Vector2d point_m =
        R_robot_world * (joint.points_m[static_cast<std::size_t>(i)] - joint.pose.position_m());
    relative.points_m.push_back(point_m);
    relative.J.block<2, 2>(2 * i, 0) = -R_robot_world;
    relative.J.block<2, 1>(2 * i, 2) = Eigen::Vector2d(point_m.y(), -point_m.x());
    relative.J.block<2, 2>(2 * i, 3 + 2 * i) = R_robot_world;
  }
  relative.P = relative.J * joint.covariance * relative.J.transpose();
  return relative;
}

/// The sensor's pose from the point(s) of its clone; `first` is the column of its position.
void place_sensor(const RelativePoints& relative, Index first, FitRow& row) {
  const Eigen::Vector2d position_m = relative.points_m[static_cast<std::size_t>(first / 2)];
  row.first = first;
  row.J.setZero(3, row.kind == core::ObservationKind::bearing ? 4 : 2);
  row.J.topLeftCorner<2, 2>().setIdentity();
  double heading_rad = 0.0;
  if (row.kind == core::ObservationKind::bearing) {
    const Eigen::Vector2d way_m = relative.points_m[static_cast<std::size_t>(first / 2 + 1)] - position_m;
    heading_rad = std::atan2(way_m.y(), way_m.x());
    const Eigen::RowVector2d by_ahead = Eigen::RowVector2d(-way_m.y(), way_m.x()) / way_m.squaredNorm();
    row.J.block<1, 2>(2, 0) = -by_ahead;
    row.J.block<1, 2>(2, 2) = by_ahead;
  }
  row.sensor = core::Pose2(position_m.x(), position_m.y(), heading_rad);
}

double largest_sigma(const Eigen::Matrix2d& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[1]);
}

double nearest_sensor_m(const std::vector<FitRow>& rows, const Eigen::Vector2d& point_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const FitRow& row : rows) nearest_m = std::min(nearest_m, (row.sensor.position_m() - point_m).norm());
  return nearest_m;
}

bool is_contradicted(const FittedPoint& best, std::size_t rows, const DelayedOptions& options) {
  return best.nis > core::chi2_quantile(options.fit_probability, static_cast<int>(rows) - 2);
}

bool is_settled(const std::vector<FittedPoint>& solutions, const std::vector<FitRow>& rows,
                const DelayedOptions& options) {
  if (solutions.empty()) return false;
  const FittedPoint& best = solutions.front();
  if (solutions.size() > 1 && solutions[1].cost - best.cost < options.min_rival_margin) return false;
  if (is_contradicted(best, rows.size(), options)) return false;
  return largest_sigma(best.covariance_m2) < options.max_relative_sigma * nearest_sensor_m(rows, best.point_m);
}

/// From the frame of the robot into the map, with the pose's share in it.
cekf::DerivedPoint in_map(const FittedPoint& fitted, const core::JointGaussian& joint, const RelativePoints& relative) {
  cekf::DerivedPoint point;
  const Eigen::Matrix2d R_world_robot = core::rotation(joint.pose.heading_rad);
  const Eigen::Vector2d arm_m = R_world_robot * fitted.point_m;
  point.point_m = joint.pose.position_m() + arm_m;
  point.ids = joint.ids;
  point.G = R_world_robot * fitted.G * relative.J;
  point.G.leftCols<2>() += Eigen::Matrix2d::Identity();
  point.G.col(2) += Eigen::Vector2d(-arm_m.y(), arm_m.x());
  const Eigen::Matrix2d noise = R_world_robot * fitted.noise_m2 * R_world_robot.transpose();
  point.noise_m2 = 0.5 * (noise + noise.transpose());
  return point;
}

template <class Sightings>
std::vector<LandmarkId> clones_of(const Sightings& sightings) {
  std::vector<LandmarkId> ids;
  for (const auto& sighting : sightings) {
    ids.push_back(sighting.position);
    if (sighting.ahead != core::no_landmark) ids.push_back(sighting.ahead);
  }
  return ids;
}

/// Where a landmark is according to its sightings, and how well they agree.
struct Located {
  std::optional<cekf::DerivedPoint> point;
  double nis = 0.0;              ///< of the best solution
  bool is_contradicted = false;  ///< by sightings that do not fit it
};

template <class Sightings>
Located locate(const cekf::CompressedEkf& filter, const Sightings& sightings, const DelayedOptions& options) {
  if (sightings.size() < 4) return {};
  const core::JointGaussian joint = filter.joint(clones_of(sightings));
  const RelativePoints relative = relative_points(joint);
  std::vector<FitRow> rows;
  Index first = 0;
  for (const auto& sighting : sightings) {
    FitRow& row = rows.emplace_back();
    row.kind = sighting.observation.kind;
    row.z = sighting.observation.z[0];
    row.variance = sighting.observation.R(0, 0);
    place_sensor(relative, first, row);
    first += sighting.ahead == core::no_landmark ? 2 : 4;
  }
  const std::vector<FittedPoint> solutions = fit_from_everywhere(rows, relative.P, options.spacing_m, options.same_m);
  Located located;
  if (solutions.empty()) return located;
  located.nis = solutions.front().nis;
  located.is_contradicted = is_contradicted(solutions.front(), rows.size(), options);
  if (is_settled(solutions, rows, options) && looks_gaussian(rows, relative.P, solutions.front()))
    located.point = in_map(solutions.front(), joint, relative);
  return located;
}

/// One sighting bore another landmark's name if all others agree without it and it is far off: two sightings and noise
/// do not do that.
template <class Sightings>
std::optional<cekf::DerivedPoint> locate_without_one(const cekf::CompressedEkf& filter, const Sightings& sightings,
                                                     double nis, const DelayedOptions& options) {
  constexpr std::size_t least_others = 5;  // three more than place it
  constexpr double least_gain = 30.0;      // one in a thousand is wrong, somewhere in view
  std::optional<cekf::DerivedPoint> point;
  if (sightings.size() <= least_others) return point;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    Sightings others = sightings;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    Located located = locate(filter, others, options);
    if (!located.point || nis - located.nis < least_gain) continue;
    if (point) return std::nullopt;  // either of the two might be the wrong one
    point = std::move(located.point);
  }
  return point;
}

}  // namespace

std::optional<LandmarkId> DelayedLandmarks::sight(cekf::CompressedEkf& filter, std::int64_t identity,
                                                  const core::Observation& observation,
                                                  const core::Pose2& T_robot_sensor) {
  core::check_observation(observation);
  if (core::dimension(observation.kind) != 1) {
    throw core::PreconditionError("sight: an observation of two rows needs no delay");
  }
  Window& window = windows_[identity];
  if (window.spacing_m == 0.0) window.spacing_m = options_.spacing_m;
  const Eigen::Vector2d sensor_m = core::transform(filter.pose().mean, T_robot_sensor.position_m());
  if (!window.sightings.empty() &&
      (filter.landmark(window.sightings.back().position).mean_m - sensor_m).norm() < window.spacing_m) {
    return std::nullopt;
  }
  if (static_cast<int>(window.sightings.size()) >= options_.window) thin_out(filter, window);
  Sighting sighting{observation, clone(filter, T_robot_sensor.position_m(), options_.clone_sigma_m), core::no_landmark};
  if (observation.kind == core::ObservationKind::bearing) {
    sighting.ahead =
        clone(filter, core::transform(T_robot_sensor, Eigen::Vector2d(options_.ahead_m, 0.0)), options_.clone_sigma_m);
  }
  window.sightings.push_back(sighting);

  Located located = locate(filter, window.sightings, options_);
  if (!located.point && located.is_contradicted && options_.names_may_be_wrong)
    located.point = locate_without_one(filter, window.sightings, located.nis, options_);
  if (!located.point) return std::nullopt;
  const LandmarkId landmark = filter.augment(*located.point);
  for (const LandmarkId id : clones_of(window.sightings)) filter.remove(id);
  windows_.erase(identity);
  return landmark;
}

void DelayedLandmarks::thin_out(cekf::CompressedEkf& filter, Window& window) const {
  std::vector<Sighting> kept;
  for (std::size_t i = 0; i < window.sightings.size(); ++i) {
    if (i % 2 == 0) {
      kept.push_back(window.sightings[i]);
    } else {
      for (const LandmarkId id : clones_of(std::vector<Sighting>{window.sightings[i]})) filter.remove(id);
    }
  }
  window.sightings = kept;
  window.spacing_m *= 2.0;
}

bool DelayedLandmarks::is_clone(LandmarkId id) const {
  return std::any_of(windows_.begin(), windows_.end(), [&](const auto& entry) {
    const std::vector<LandmarkId> ids = clones_of(entry.second.sightings);
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  });
}

int DelayedLandmarks::clones() const {
  std::size_t count = 0;
  for (const auto& entry : windows_) count += clones_of(entry.second.sightings).size();
  return static_cast<int>(count);
}

}  // namespace helixnav::supervisor
