// SPDX-License-Identifier: BSD-3-Clause
#include "reading/rawlog_movement.hpp"

#include <memory>

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "reading/rawlog_time.hpp"

namespace helixnav::apps {

mrpt::obs::CActionCollection movement_of(const core::Odometry& odometry) {
  mrpt::obs::CActionRobotMovement2D movement;
  movement.timestamp = rawlog_time(odometry.t_ns);
  movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  const core::Pose2& moved = odometry.T_before_after;
  const auto pdf =
      std::make_shared<mrpt::poses::CPosePDFGaussian>(mrpt::poses::CPose2D(moved.x_m, moved.y_m, moved.heading_rad));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pdf->cov(row, column) = odometry.covariance(row, column);
  }
  movement.poseChange = mrpt::poses::CPosePDF::Ptr(pdf);
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  return actions;
}

}  // namespace helixnav::apps
