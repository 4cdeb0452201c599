// SPDX-License-Identifier: BSD-3-Clause
#include "random_program.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::cekf {
namespace {

constexpr double radius_m = 40.0;
constexpr double range_m = 20.0;

core::PoseGaussian start(bool known) {
  core::PoseGaussian result;
  result.mean = core::Pose2(radius_m, 0.0, 0.5 * core::pi);
  if (!known) result.covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  return result;
}

FilterOptions options(Retraction retraction) {
  FilterOptions result;
  result.retraction = retraction;
  result.cell_side_m = 25.0;
  result.hysteresis_m = 3.0;
  return result;
}

}  // namespace

Differences compare(const CompressedEkf& filter, const support::FullEkf& oracle) {
  const core::JointGaussian joint = filter.joint(oracle.ids);
  Differences result;
  result.covariance = (joint.covariance - oracle.P).cwiseAbs().maxCoeff() / oracle.P.cwiseAbs().maxCoeff();
  const Eigen::Vector3d pose_error = joint.pose.vector() - oracle.x.head<3>();
  result.mean = std::max(pose_error.head<2>().cwiseAbs().maxCoeff(), std::abs(core::wrap_to_pi(pose_error[2])));
  for (std::size_t i = 0; i < oracle.ids.size(); ++i) {
    const Eigen::Vector2d error = joint.points_m[i] - oracle.x.segment<2>(3 + 2 * static_cast<Eigen::Index>(i));
    result.mean = std::max(result.mean, error.cwiseAbs().maxCoeff());
  }
  result.mean /= oracle.x.cwiseAbs().maxCoeff();
  return result;
}

RandomProgram::RandomProgram(std::uint64_t seed, const Settings& settings)
    : filter(start(settings.start_known), options(settings.retraction)),
      oracle(start(settings.start_known), settings.retraction == Retraction::right_invariant),
      random_(seed, "random program"),
      settings_(settings),
      truth_(start(true).mean) {
  // One draw per statement, here and below: compilers evaluate arguments in different orders.
  for (int i = 0; i < settings.landmarks; ++i) {
    const double y_m = random_.uniform(-60, 60);
    points_m_.emplace_back(random_.uniform(-60, 60), y_m);
  }
  ids_.assign(points_m_.size(), core::no_landmark);
}

core::Observation RandomProgram::observe(const Eigen::Vector2d& point_m, bool cartesian) {
  const core::Pose2 T_world_sensor = core::compose(truth_, T_robot_sensor_);
  const Eigen::Vector2d p = core::transform(core::inverse(T_world_sensor), point_m);
  if (cartesian) {
    Eigen::Matrix2d R;
    R << 0.02, 0.005, 0.005, 0.01;
    const double noise_y_m = random_.normal(0, 0.1);
    return core::make_cartesian(p + Eigen::Vector2d(random_.normal(0, 0.1), noise_y_m), R);
  }
  const double bearing_rad = core::wrap_to_pi(std::atan2(p.y(), p.x()) + random_.normal(0.0, 0.01));
  return core::make_range_bearing(std::max(0.1, p.norm() + random_.normal(0.0, 0.1)), bearing_rad, 0.1, 0.01);
}

core::LandmarkId RandomProgram::map_again(core::LandmarkId id) {
  const std::size_t landmark = static_cast<std::size_t>(std::find(ids_.begin(), ids_.end(), id) - ids_.begin());
  const core::Observation z = observe(points_m_[landmark], false);
  const core::LandmarkId again = filter.augment(z, T_robot_sensor_);
  oracle.augment(again, z, T_robot_sensor_);
  return again;
}

void RandomProgram::step() {
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(0.5, 0.0, 0.5 / radius_m);
  odometry.covariance << 4e-4, 1e-5, 0, 1e-5, 1e-4, 2e-5, 0, 2e-5, 1e-4;
  const Eigen::Vector3d noise = 0.3 * random_.normal3(odometry.covariance);
  truth_ = core::compose(truth_, core::Pose2(odometry.T_before_after.vector() + noise));
  filter.predict(odometry);
  oracle.predict(odometry);
  ++steps_;
  if (steps_ % 2 == 0) scan();
  if (random_.bernoulli(0.03)) remove_some();
  if (random_.bernoulli(0.03)) activate_some();
  if (settings_.steps_per_switch > 0 && steps_ % settings_.steps_per_switch == 0) switch_region_randomly();
}

void RandomProgram::scan() {
  std::vector<Match> matches;
  std::vector<support::FullEkf::Sighting> sightings;
  std::vector<std::size_t> fresh;
  for (std::size_t i = 0; i < points_m_.size(); ++i) {
    if ((points_m_[i] - truth_.position_m()).norm() > range_m || random_.bernoulli(0.2)) continue;
    if (ids_[i] == core::no_landmark) {
      fresh.push_back(i);
      continue;
    }
    const core::Observation z = observe(points_m_[i], random_.bernoulli(0.3));
    lazy_activations += !filter.is_active(ids_[i]);
    matches.push_back({ids_[i], z, T_robot_sensor_});
    sightings.push_back({ids_[i], z, T_robot_sensor_});
  }
  if (!matches.empty()) {
    filter.update(matches);
    oracle.update(sightings);
  }
  for (const std::size_t i : fresh) {
    const core::Observation z = observe(points_m_[i], false);
    ids_[i] = filter.augment(z, T_robot_sensor_);
    oracle.augment(ids_[i], z, T_robot_sensor_);
  }
}

void RandomProgram::remove_some() {
  for (const bool active : {true, false}) {
    for (std::size_t i = random_.below(ids_.size()); i < ids_.size(); ++i) {
      if (ids_[i] == core::no_landmark || filter.is_active(ids_[i]) != active) continue;
      filter.remove(ids_[i]);
      oracle.remove(ids_[i]);
      ids_[i] = core::no_landmark;
      ++removed;
      break;
    }
  }
}

void RandomProgram::activate_some() {
  for (std::size_t i = random_.below(ids_.size()); i < ids_.size(); ++i) {
    if (ids_[i] == core::no_landmark || filter.is_active(ids_[i])) continue;
    filter.activate(ids_[i]);
    ++lazy_activations;
    return;
  }
}

void RandomProgram::start_oracle_from_filter() {
  const core::JointGaussian joint = filter.joint(oracle.ids);
  oracle.x.head<3>() = joint.pose.vector();
  for (std::size_t i = 0; i < joint.points_m.size(); ++i) {
    oracle.x.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) = joint.points_m[i];
  }
  oracle.P = joint.covariance;
}

void RandomProgram::switch_region_randomly() {
  const double kind = random_.uniform();
  if (kind < 0.4) {
    filter.switch_region();
  } else if (kind < 0.6) {
    filter.global_update();
  } else {
    const double reach_m = random_.uniform(5.0, 30.0);
    std::vector<core::LandmarkId> near;
    for (const core::LandmarkId id : filter.landmarks()) {
      if ((filter.landmark(id).mean_m - filter.pose().mean.position_m()).norm() < reach_m) near.push_back(id);
    }
    filter.switch_region(near);
  }
  ++switches;
}

}  // namespace helixnav::cekf
