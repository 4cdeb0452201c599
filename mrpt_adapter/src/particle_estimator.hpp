// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator.hpp"
#include "helixnav/fastslam/fast_slam.hpp"

namespace helixnav::mrpt_adapter {

/// FastSLAM. Its map is that of the heaviest particle, its pose the mean of the cloud; there are no fixes, no joint estimate and
/// no search. Until the first measurements there is a cloud for landmarks with names and one for those without.
class ParticleEstimator : public Estimator {
 public:
  ParticleEstimator(const core::PoseGaussian& start, const fastslam::Options& options, std::uint64_t seed);

  void move(const core::Odometry& odometry) override;
  void fix(const core::AbsoluteFix&) override {}
  core::StepReport observe_nothing(const core::Scan& scan) override;
  core::StepReport observe(const core::Scan& scan) override;
  core::StepReport observe(const core::Scan& scan, const std::vector<std::int64_t>& identities) override;

  core::PoseGaussian pose() const override;
  std::vector<core::MapLandmark> map() const override { return cloud().map(); }
  /// Of the heaviest particle; landmarks are independent given its path, and the pose's covariance is the cloud's.
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const override;
  std::vector<WeightedPose> particles() const override;
  core::JointMap joint_map() const override;
  bool place_is_known() const override { return true; }
  std::optional<core::JointMap> sought_in() const override { return std::nullopt; }
  void lose() override;

 private:
  const fastslam::FastSlam& cloud() const { return unnamed_ ? *unnamed_ : *named_; }
  core::StepReport noted(core::StepReport report);

  core::PoseGaussian pose_;  ///< at the last scan
  std::optional<fastslam::FastSlam> named_;
  std::optional<fastslam::FastSlam> unnamed_;
};

}  // namespace helixnav::mrpt_adapter
