// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/mrpt_adapter/map_builder.hpp"

namespace helixnav::mrpt_adapter {

/// One step of the last call that fed a builder.
struct Step {
  core::StepReport report;
  double microseconds = 0.0;  ///< wall clock of the navigator, without conversion
};

/// The builder in HelixNav's own types, as runs::RunWriter requires them. These hold Eigen matrices: whoever uses this
/// must compile with the same vector instructions as this library, which is why MapBuilder itself does not expose them.
/// Not locked against a thread that feeds the builder.
class RunAccess {
 public:
  /// Of the last processActionObservation or processObservation; empty when it held nothing to see.
  static const std::vector<Step>& last_steps(const MapBuilder& builder);
  static std::vector<core::MapLandmark> map(const MapBuilder& builder);
  /// What another session needs to continue; nothing for FastSLAM.
  static std::optional<core::JointMap> joint_map(const MapBuilder& builder);
  static core::PoseGaussian pose(const MapBuilder& builder);
};

}  // namespace helixnav::mrpt_adapter
