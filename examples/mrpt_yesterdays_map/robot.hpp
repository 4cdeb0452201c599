// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <random>

#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

/// Stands in for your robot: it drives a circle of 16 m radius, 1 m per frame, among 60 trees, seen up to 15 m away.
class Robot {
 public:
  explicit Robot(double begin_m) : along_m_(begin_m) {
    for (mrpt::math::TPoint2D& tree : trees_) tree = {uniform(-30.0, 30.0), uniform(-14.0, 46.0)};
  }

  mrpt::obs::CActionCollection moved() {
    along_m_ += 1.0;
    mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
    mrpt::obs::CActionRobotMovement2D movement;
    movement.computeFromOdometry(pose_at(1.0), model);
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    return actions;
  }

  mrpt::obs::CSensoryFrame seen() {
    const auto observation = std::make_shared<mrpt::obs::CObservationBearingRange>();
    observation->timestamp = mrpt::Clock::fromDouble(1e9 + time_s_++);
    observation->maxSensorDistance = 15.0F;
    observation->fieldOfView_yaw = static_cast<float>(2.0 * M_PI);
    for (const mrpt::math::TPoint2D& tree : trees_) {
      const mrpt::math::TPoint2D p = pose().asTPose().inverseComposePoint(tree);
      if (p.norm() > 15.0) continue;
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

  /// Somebody carries it along the way.
  void carry(double distance_m) { along_m_ += distance_m; }

  mrpt::poses::CPose2D pose() const { return pose_at(along_m_); }

  static mrpt::math::CMatrixDouble33 start_covariance() {
    mrpt::math::CMatrixDouble33 covariance;
    covariance(0, 0) = covariance(1, 1) = 0.04;
    covariance(2, 2) = 1e-3;
    return covariance;
  }

 private:
  static constexpr double radius_m = 16.0;

  /// This far along the circle, from where it begins.
  static mrpt::poses::CPose2D pose_at(double along_m) {
    const double angle_rad = along_m / radius_m;
    return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad)), angle_rad};
  }

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / static_cast<double>(std::mt19937::max());
  }

  std::mt19937 random_{7};
  mrpt::math::TPoint2D trees_[60];
  double along_m_;
  double time_s_ = 0.0;
};
