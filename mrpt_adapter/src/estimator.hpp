// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::mrpt_adapter {

struct WeightedPose {
  core::Pose2 T_world_robot;
  double log_weight = 0.0;
};

/// What a builder feeds. Whether landmarks are known by name is settled by the first call of an `observe` with measurements
/// and stays so.
class Estimator {
 public:
  Estimator() = default;
  virtual ~Estimator() = default;
  Estimator(const Estimator&) = delete;
  Estimator& operator=(const Estimator&) = delete;

  virtual void move(const core::Odometry& odometry) = 0;
  virtual void fix(const core::AbsoluteFix& fix) = 0;
  /// A scan without measurements: how landmarks are known stays open.
  virtual core::StepReport observe_nothing(const core::Scan& scan) = 0;
  virtual core::StepReport observe(const core::Scan& scan) = 0;
  virtual core::StepReport observe(const core::Scan& scan, const std::vector<std::int64_t>& identities) = 0;

  virtual core::PoseGaussian pose() const = 0;
  virtual std::vector<core::MapLandmark> map() const = 0;
  virtual core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const = 0;
  /// Where the estimate is a cloud; else empty.
  virtual std::vector<WeightedPose> particles() const = 0;

  /// What another session needs to go on. PreconditionError where there is no joint estimate.
  virtual core::JointMap joint_map() const = 0;
  virtual bool place_is_known() const = 0;
  /// The earlier map, of several the first, on which the place is still sought.
  virtual std::optional<core::JointMap> sought_in() const = 0;
  /// As supervisor::Navigator::lose. PreconditionError where landmarks are known by name or there is no search.
  virtual void lose() = 0;
};

}  // namespace helixnav::mrpt_adapter
