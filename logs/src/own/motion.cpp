// SPDX-License-Identifier: BSD-3-Clause
#include "motion.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "helixnav/core/ackermann.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::logs {
namespace {

double square(double value) { return value * value; }

[[noreturn]] void fail_vehicle(const Vehicle& vehicle, const std::string& message) {
  throw core::InputError((vehicle.path.empty() ? std::string("no vehicle.toml") : vehicle.path) + ": " + message);
}

void check_geometry(const OwnLog& log, const Vehicle& vehicle) {
  if (log.odometry_kind == OdometryKind::steering && !vehicle.odometry.wheelbase_m) {
    fail_vehicle(vehicle, "odometry by steering angle needs wheelbase_m in section [odometry]");
  }
  if (log.odometry_kind == OdometryKind::wheels && !vehicle.odometry.track_m) {
    fail_vehicle(vehicle, "odometry by two wheels needs track_m, the distance between them, in section [odometry]");
  }
  if (!log.odometry_covariances.empty() || vehicle.odometry.tells_noise()) return;
  fail_vehicle(
      vehicle,
      "no noise of the odometry is given: neither a column of odometry.csv nor a key of section [odometry], "
      "as sigma_along_m_per_sqrt_m and sigma_heading_deg_per_sqrt_m; 'helixnav new-vehicle' writes an example");
}

/// Rotation of a twist's chord relative to its ends.
Eigen::Matrix3d half_turned(double turn_rad) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = core::rotation(0.5 * turn_rad);
  return R;
}

/// Jacobian of an increment with respect to the rates it is made from, to first order.
Eigen::Matrix3d by_rates(const Eigen::Vector3d& twist, double duration_s) {
  if (!(square(duration_s) > 0.0)) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -0.5 * twist.y();
  J(1, 2) = 0.5 * twist.x();
  return duration_s * half_turned(twist.z()) * J;
}

/// Variance of the integral of a random walk of variance 1 per second, s seconds after its start: ∫ t² dt. No rate
/// changes without limit: after ten seconds it grows no faster.
double walked_s3(double s) {
  constexpr double most_s = 10.0;
  const double walking_s = std::min(s, most_s);
  return square(walking_s) * (walking_s / 3.0 + (s - walking_s));
}

/// What rates that may change add to the covariance of a part of a motion.
Eigen::Matrix3d change_of_rates(const Motion& motion, double share, core::Nanoseconds from_ns,
                                core::Nanoseconds to_ns) {
  const double duration_s = core::seconds(to_ns - from_ns);
  const double s3 =
      walked_s3(core::seconds(to_ns - motion.begin_ns)) - walked_s3(core::seconds(from_ns - motion.begin_ns));
  const Eigen::Matrix3d J = by_rates(share * motion.twist, duration_s) / duration_s;
  return J * (s3 * motion.rate_walk).asDiagonal() * J.transpose();
}

}  // namespace

core::Pose2 exponential(const Eigen::Vector3d& twist) {
  const double a = twist.z();
  const bool small = std::abs(a) < 1e-4;
  const double sinc = small ? 1.0 - a * a / 6.0 : std::sin(a) / a;
  const double cosc = small ? a * (0.5 - a * a / 24.0) : (1.0 - std::cos(a)) / a;
  return {sinc * twist.x() - cosc * twist.y(), cosc * twist.x() + sinc * twist.y(), a};
}

Eigen::Vector3d logarithm(const Eigen::Vector3d& increment) {
  const double half = 0.5 * increment.z();
  const double cot = std::abs(half) < 1e-4 ? 1.0 - half * half / 3.0 : half / std::tan(half);
  return {cot * increment.x() + half * increment.y(), cot * increment.y() - half * increment.x(), increment.z()};
}

Motions::Motions(const OwnLog& log, const Vehicle& vehicle) : log_(log), model_(vehicle.odometry) {
  check_geometry(log, vehicle);
}

bool Motions::holds() const {
  return log_.odometry_kind != OdometryKind::increments && log_.odometry_kind != OdometryKind::poses;
}

Motion Motions::stretch(std::size_t row, core::Nanoseconds last_ns) const {
  Motion motion;
  const core::Nanoseconds t_ns = log_.odometry[row].t_ns;
  if (holds()) {
    motion.begin_ns = t_ns;
    motion.end_ns = row + 1 < log_.odometry.size() ? log_.odometry[row + 1].t_ns : std::max(t_ns, last_ns);
  } else {
    motion.begin_ns = row > 0 ? log_.odometry[row - 1].t_ns : first_begin_ns();
    motion.end_ns = t_ns;
  }
  return motion;
}

/// Of the first increment. A row of zeros only says when the log begins.
core::Nanoseconds Motions::first_begin_ns() const {
  const OwnOdometry& first = log_.odometry.front();
  if (log_.odometry.size() < 2 || first.value.isZero(0.0)) return first.t_ns;
  return first.t_ns - (log_.odometry[1].t_ns - first.t_ns);
}

/// The interval before the row, if it reports that the vehicle stands still through a gap.
std::optional<core::Nanoseconds> Motions::stands_through_gap(std::size_t row, const Motion& motion) const {
  if (!holds() || row == 0) return std::nullopt;
  const Eigen::Vector3d& value = log_.odometry[row].value;
  const bool is_steered = log_.odometry_kind == OdometryKind::steering;
  if (is_steered ? value[0] != 0.0 : !value.isZero(0.0)) return std::nullopt;
  constexpr core::Nanoseconds least_gap_ns = 1'000'000'000;
  const core::Nanoseconds usual_ns = log_.odometry[row].t_ns - log_.odometry[row - 1].t_ns;
  const bool is_gap = motion.end_ns - motion.begin_ns > std::max(least_gap_ns, 10 * usual_ns);
  return is_gap ? std::optional(usual_ns) : std::nullopt;
}

/// Twist of a held sample of speed and steering; its covariance by distance.
Eigen::Vector3d Motions::steered(Motion& motion, const Eigen::Vector3d& value) const {
  core::AckermannSample sample;
  sample.wheel_speed_mps = model_.scale * value[0];
  sample.steering_rad = model_.steering_scale * value[1] + model_.steering_offset_rad;
  sample.duration_s = core::seconds(motion.end_ns - motion.begin_ns);
  const core::AckermannNoise noise{model_.sigma_v_mps.value_or(0.0), model_.sigma_steering_rad.value_or(0.0)};
  const core::Odometry moved = core::ackermann_increment({*model_.wheelbase_m, model_.encoder_offset_m}, noise, sample);
  motion.covariance = moved.covariance;
  return logarithm(moved.T_before_after.vector());
}

void Motions::move(Motion& motion, std::size_t row) const {
  const Eigen::Vector3d& value = log_.odometry[row].value;
  const double duration_s = core::seconds(motion.end_ns - motion.begin_ns);
  const double bias_rad = model_.turn_bias_radps * duration_s;
  switch (log_.odometry_kind) {
    case OdometryKind::increments:
      motion.twist =
          logarithm({model_.scale * value.x(), model_.scale * value.y(), model_.turn_scale * value.z() - bias_rad});
      return;
    case OdometryKind::poses: {
      const Eigen::Vector3d moved =
          core::between(core::Pose2(log_.odometry[row - 1].value), core::Pose2(value)).vector();
      motion.twist = logarithm(moved);
      motion.twist.head<2>() *= model_.scale;
      motion.twist.z() = model_.turn_scale * motion.twist.z() - bias_rad;
      return;
    }
    case OdometryKind::velocities:
      motion.twist = duration_s *
                     Eigen::Vector3d(model_.scale * value.x(), model_.scale * value.y(), model_.turn_scale * value.z());
      motion.twist.z() -= bias_rad;
      return;
    case OdometryKind::steering:
      motion.twist = steered(motion, value);
      return;
    case OdometryKind::wheels:
      motion.twist = duration_s * Eigen::Vector3d(0.5 * model_.scale * (value[0] + value[1]), 0.0,
                                                  model_.turn_scale * (value[1] - value[0]) / *model_.track_m);
      motion.twist.z() -= bias_rad;
      return;
  }
}

void Motions::add_model_noise(Motion& motion) const {
  const double way_m = motion.twist.head<2>().norm();
  const double turns = std::abs(motion.twist.z()) / (2.0 * core::pi);
  const double duration_s = core::seconds(motion.end_ns - motion.begin_ns);
  const Eigen::Vector3d variances(square(model_.sigma_along_m_per_sqrt_m.value_or(0.0)) * way_m,
                                  square(model_.sigma_sideways_m_per_sqrt_m.value_or(0.0)) * way_m,
                                  square(model_.sigma_heading_rad_per_sqrt_m.value_or(0.0)) * way_m +
                                      square(model_.sigma_heading_rad_per_sqrt_s.value_or(0.0)) * duration_s +
                                      square(model_.sigma_heading_rad_per_sqrt_turn.value_or(0.0)) * turns);
  const Eigen::Matrix3d R = half_turned(motion.twist.z());
  motion.covariance += R * variances.asDiagonal() * R.transpose();
}

/// Variances of speed and turn rate. The two wheels err independently if no noise of the turn rate is given.
Eigen::Matrix3d Motions::sample_noise() const {
  const double v = square(model_.sigma_v_mps.value_or(0.0));
  Eigen::Matrix3d rates = Eigen::Matrix3d::Zero();
  if (log_.odometry_kind == OdometryKind::wheels && !model_.sigma_omega_radps) {
    rates(0, 0) = 0.5 * v;
    rates(2, 2) = 2.0 * v / square(*model_.track_m);
  } else {
    rates(0, 0) = v;
    rates(2, 2) = square(model_.sigma_omega_radps.value_or(0.0));
  }
  return rates;
}

/// Noise that is constant over the sample.
void Motions::add_sample_noise(Motion& motion, std::size_t row) const {
  const double duration_s = core::seconds(motion.end_ns - motion.begin_ns);
  const bool given = !log_.odometry_covariances.empty() && !log_.odometry_covariances[row].isZero(0.0);
  const Eigen::Matrix3d rates = given ? log_.odometry_covariances[row] : sample_noise();
  const Eigen::Matrix3d J = by_rates(motion.twist, duration_s);
  motion.covariance += J * rates * J.transpose();
}

/// Takes the rates that rows up to this one state.
void Motions::take_held_rates(std::size_t row) {
  for (; taken_ <= row; ++taken_) {
    Motion second;
    second.end_ns = 1'000'000'000;
    move(second, taken_);
    changes_.take(log_.odometry[taken_].t_ns, second.twist);
  }
}

/// Takes the rates of the motion that a row ends.
void Motions::take_mean_rates(std::size_t row, const Motion& motion) {
  const double duration_s = core::seconds(motion.end_ns - motion.begin_ns);
  if (row < taken_ || !(duration_s > 0.0)) return;
  changes_.take(motion.end_ns, motion.twist / duration_s);
  taken_ = row + 1;
}

std::optional<Motion> Motions::of_row(std::size_t row, core::Nanoseconds last_ns) {
  if (row == 0 && log_.odometry_kind == OdometryKind::poses) return std::nullopt;
  Motion motion = stretch(row, last_ns);
  const core::Nanoseconds end_ns = motion.end_ns;
  const auto usual_ns = stands_through_gap(row, motion);
  if (usual_ns) motion.end_ns = motion.begin_ns + *usual_ns;
  move(motion, row);
  const bool own = log_.odometry_kind == OdometryKind::increments && !log_.odometry_covariances.empty() &&
                   !log_.odometry_covariances[row].isZero(0.0);
  if (own) {
    motion.covariance = log_.odometry_covariances[row];
  } else {
    add_model_noise(motion);
  }
  if (log_.odometry_kind == OdometryKind::velocities || log_.odometry_kind == OdometryKind::wheels) {
    add_sample_noise(motion, row);
  }
  if (usual_ns) motion.twist.setZero();  // also if it came from a bias
  motion.end_ns = end_ns;
  holds() ? take_held_rates(row) : take_mean_rates(row, motion);
  if (holds() && !usual_ns && changes_.is_gap(end_ns - motion.begin_ns)) motion.rate_walk = changes_.variance_per_s();
  motion.covariance = 0.5 * square(model_.noise_scale) * (motion.covariance + motion.covariance.transpose()).eval();
  last_ = motion;
  return motion;
}

std::optional<Motion> Motions::beyond_last() const {
  if (holds() || !last_ || last_->begin_ns == last_->end_ns) return std::nullopt;
  Motion motion = *last_;
  motion.begin_ns = last_->end_ns;
  motion.end_ns += last_->end_ns - last_->begin_ns;
  motion.rate_walk = changes_.variance_per_s();
  return motion;
}

core::Odometry part_of(const Motion& motion, core::Nanoseconds from_ns, core::Nanoseconds to_ns,
                       const core::Pose2& T_vehicle_odometry) {
  const bool instantaneous = motion.end_ns == motion.begin_ns;
  const double share =
      instantaneous ? 1.0 : core::seconds(to_ns - from_ns) / core::seconds(motion.end_ns - motion.begin_ns);
  core::Odometry part;
  part.t_ns = to_ns;
  Eigen::Matrix3d Q = share * motion.covariance;
  if (motion.may_change()) Q += change_of_rates(motion, share, from_ns, to_ns);
  const core::Pose2 moved = exponential(share * motion.twist);
  if (T_vehicle_odometry.vector().isZero(0.0)) {
    part.T_before_after = moved;
    part.covariance = Q;
    return part;
  }
  const core::Pose2 T_odometry_vehicle = core::inverse(T_vehicle_odometry);
  const core::Pose2 T_vehicle_moved = core::compose(T_vehicle_odometry, moved);
  const Eigen::Matrix3d J = core::compose_jacobians(T_vehicle_moved, T_odometry_vehicle).J_first *
                            core::compose_jacobians(T_vehicle_odometry, moved).J_second;
  part.T_before_after = core::compose(T_vehicle_moved, T_odometry_vehicle);
  Q = motion.may_change() ? (J * Q * J.transpose()).eval() : (share * (J * motion.covariance * J.transpose())).eval();
  part.covariance = 0.5 * (Q + Q.transpose());
  return part;
}

}  // namespace helixnav::logs
