// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>

#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>

/// Stands in for your robot: two laps of a circle of 10 m radius, with a landmark every 30° beside it.
class Robot {
 public:
  bool drives() { return ++step_ <= 120; }

  mrpt::obs::CActionCollection moved() const {
    mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
    mrpt::obs::CActionRobotMovement2D movement;
    movement.computeFromOdometry(mrpt::poses::CPose2D(radius_m * turn_rad, 0.0, turn_rad), model);
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    return actions;
  }

  mrpt::obs::CSensoryFrame seen() const {
    const auto observation = std::make_shared<mrpt::obs::CObservationBearingRange>();
    observation->maxSensorDistance = 8.0F;
    observation->fieldOfView_yaw = static_cast<float>(2.0 * M_PI);
    for (int i = 0; i < 12; ++i) {
      const mrpt::math::TPoint2D landmark(13.0 * std::sin(i * M_PI / 6.0), 10.0 - 13.0 * std::cos(i * M_PI / 6.0));
      const mrpt::math::TPoint2D p = pose().asTPose().inverseComposePoint(landmark);
      if (p.norm() > 8.0) continue;
      mrpt::obs::CObservationBearingRange::TMeasurement measured{};
      measured.range = static_cast<float>(p.norm());
      measured.yaw = static_cast<float>(std::atan2(p.y, p.x));
      measured.landmarkID = mrpt::obs::INVALID_LANDMARK_ID;
      observation->sensedData.push_back(measured);
    }
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation);
    return frame;
  }

 private:
  static constexpr double radius_m = 10.0;
  static constexpr double turn_rad = 2.0 * M_PI / 60.0;

  mrpt::poses::CPose2D pose() const {
    mrpt::poses::CPose2D pose;
    for (int k = 0; k < step_; ++k) pose = pose + mrpt::poses::CPose2D(radius_m * turn_rad, 0.0, turn_rad);
    return pose;
  }

  int step_ = 0;
};
