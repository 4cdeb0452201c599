// SPDX-License-Identifier: BSD-3-Clause
#include "mrclam/command_motion.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/odometry.hpp"

namespace helixnav::logs {

core::Odometry CommandMotion::held(const MrclamTables::Command& command, core::Nanoseconds until_ns) const {
  const double dt_s = core::seconds(until_ns - now_ns_);
  const double distance_m = command.speed_mps * dt_s;
  const double half_turn_rad = 0.5 * command.turn_rad_per_s * dt_s;
  const double chord_m = half_turn_rad == 0.0 ? distance_m : distance_m * std::sin(half_turn_rad) / half_turn_rad;
  const bool stands = command.speed_mps == 0.0 && command.turn_rad_per_s == 0.0;
  const Eigen::Vector3d sigmas(settings_.sigma_speed_m_per_sqrt_s, settings_.sigma_side_m_per_sqrt_s,
                               settings_.sigma_turn_rad_per_sqrt_s);
  const double share = stands ? settings_.standing : 1.0;
  core::Odometry motion;
  motion.t_ns = until_ns;
  motion.T_before_after =
      core::Pose2(chord_m * std::cos(half_turn_rad), chord_m * std::sin(half_turn_rad), 2.0 * half_turn_rad);
  motion.covariance = (dt_s * share * share * sigmas.cwiseAbs2()).asDiagonal();
  return motion;
}

core::Odometry CommandMotion::until(core::Nanoseconds t_ns) {
  core::Odometry motion = core::no_motion(now_ns_);
  while (now_ns_ < t_ns) {
    while (next_ < commands_.size() && commands_[next_].t_ns <= now_ns_) ++next_;
    const core::Nanoseconds end_ns = next_ < commands_.size() ? std::min(t_ns, commands_[next_].t_ns) : t_ns;
    const MrclamTables::Command in_force = next_ == 0 ? MrclamTables::Command{} : commands_[next_ - 1];
    motion = core::chain(motion, held(in_force, end_ns));
    now_ns_ = end_ns;
  }
  motion.t_ns = now_ns_;
  return motion;
}

}  // namespace helixnav::logs
