// SPDX-License-Identifier: BSD-3-Clause
#include "run_interpolation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace helixnav::evaluation {

namespace {

// Maps the translation of a unit twist with rotation `angle` to its chord: [[s, -c], [c, s]] with s = sin a / a and
// c = (1 - cos a) / a.
Eigen::Matrix2d chord_of_twist(double angle_rad) {
  const bool small = std::abs(angle_rad) < 1e-6;
  const double s = small ? 1.0 - angle_rad * angle_rad / 6.0 : std::sin(angle_rad) / angle_rad;
  const double c = small ? 0.5 * angle_rad : (1.0 - std::cos(angle_rad)) / angle_rad;
  return (Eigen::Matrix2d() << s, -c, c, s).finished();
}

}  // namespace

core::Pose2 interpolate(const core::Pose2& T_world_a, const core::Pose2& T_world_b, double fraction) {
  const core::Pose2 T_a_b = core::between(T_world_a, T_world_b);
  const double angle = T_a_b.heading_rad;
  const Eigen::Vector2d twist = chord_of_twist(angle).inverse() * T_a_b.position_m();
  const Eigen::Vector2d chord = chord_of_twist(fraction * angle) * (fraction * twist);
  return core::compose(T_world_a, core::Pose2(chord.x(), chord.y(), fraction * angle));
}

std::optional<core::PoseGaussian> estimate_at(const std::vector<core::StepReport>& steps, core::Nanoseconds t_ns) {
  const auto after = std::upper_bound(steps.begin(), steps.end(), t_ns,
                                      [](core::Nanoseconds t, const core::StepReport& step) { return t < step.t_ns; });
  if (after == steps.begin()) return std::nullopt;
  const core::StepReport& before = *(after - 1);
  if (before.t_ns == t_ns) return before.pose;
  if (after == steps.end()) return std::nullopt;
  const double fraction = static_cast<double>(t_ns - before.t_ns) / static_cast<double>(after->t_ns - before.t_ns);
  return core::PoseGaussian{interpolate(before.pose.mean, after->pose.mean, fraction), before.pose.covariance};
}

}  // namespace helixnav::evaluation
