// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

namespace helixnav::testing {

/// MRPT's own filter, for comparison: its defaults except for these, silent and without its profiler.
class KfSlam {
 public:
  using Landmarks = std::map<std::int64_t, Eigen::Vector2d>;

  KfSlam(double sigma_range_m, double sigma_bearing_rad, mrpt::bayes::TKFMethod method = mrpt::bayes::kfEKFNaive) {
    filter_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    filter_.KF_options.method = method;
    filter_.KF_options.verbosity_level = mrpt::system::LVL_ERROR;
    filter_.KF_options.enable_profiler = false;
    filter_.options.std_sensor_range = static_cast<float>(sigma_range_m);
    filter_.options.std_sensor_yaw = static_cast<float>(sigma_bearing_rad);
  }

  void take(mrpt::obs::CActionCollection::Ptr& action, mrpt::obs::CSensoryFrame::Ptr& frame) {
    filter_.processActionObservation(action, frame);
  }

  /// By landmarkID, or numbered by the filter where the observations have none.
  Landmarks landmarks_m() const {
    mrpt::poses::CPosePDFGaussian pose;
    std::vector<mrpt::math::TPoint2D> points;
    std::map<unsigned int, mrpt::maps::CLandmark::TLandmarkID> ids;
    mrpt::math::CVectorDouble state;
    mrpt::math::CMatrixDouble covariance;
    filter_.getCurrentState(pose, points, ids, state, covariance);
    Landmarks result;
    for (const auto& [index, id] : ids) result[static_cast<std::int64_t>(id)] = {points[index].x, points[index].y};
    return result;
  }

 private:
  mrpt::slam::CRangeBearingKFSLAM2D filter_;
};

}  // namespace helixnav::testing
