// SPDX-License-Identifier: BSD-3-Clause
#include "loop/judge_fix.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {

core::FixDecision judge_fix(cekf::CompressedEkf& filter, const WidenedFix& fix, double probability) {
  core::AbsoluteFix one = fix.fix;
  one.covariance_m2 *= fix.of_one / fix.widened;
  core::FixDecision decision;
  decision.nis = filter.position_innovation(one).nis;
  decision.gate = core::chi2_quantile(probability, 2);
  decision.accepted = decision.nis <= decision.gate;
  if (decision.accepted) filter.update_position(fix.fix);
  decision.position_world_m = one.position_world_m;
  decision.pose_sigma_m = std::sqrt(filter.pose().covariance.topLeftCorner<2, 2>().trace());
  decision.widened = fix.widened;
  return decision;
}

WidenedFix widened(const core::AbsoluteFix& fix, const FixNoise& noise) {
  WidenedFix widened{fix, noise.in_update(), noise.of_one()};
  widened.fix.covariance_m2 *= widened.widened;
  return widened;
}

FixInnovation innovation_of(const core::PoseGaussian& pose, const core::AbsoluteFix& fix) {
  const Eigen::Vector2d arm_m = core::rotation(pose.mean.heading_rad) * fix.antenna_robot_m;
  Eigen::Matrix<double, 2, 3> J;
  J << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
  const Eigen::LLT<Eigen::Matrix2d> stated(fix.covariance_m2);
  const Eigen::Matrix2d predicted = J * pose.covariance * J.transpose();
  return {stated.matrixL().solve(fix.position_world_m - pose.mean.position_m() - arm_m),
          0.5 * stated.solve(predicted).trace()};
}

}  // namespace helixnav::supervisor
