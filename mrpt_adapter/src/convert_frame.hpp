// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose2D.h>

#include "helixnav/mrpt_adapter/conversions.hpp"

namespace helixnav::mrpt_adapter {

/// What stays known between frames about where motion comes from.
struct MotionState {
  std::optional<mrpt::poses::CPose2D> last_reading;  ///< of CObservationOdometry
  std::optional<core::Nanoseconds> last_reading_ns;  ///< its time, if it had one
  std::optional<GpsReference> reference;             ///< origin of the map frame
};

using Input = std::variant<core::Odometry, NamedScan, core::AbsoluteFix>;

/// What one frame means for the navigator, in order.
struct FrameInput {
  std::vector<Input> inputs;
  std::vector<std::string> warnings;
  MotionState motion;  ///< after the frame; takes effect when the frame does
};

/// Converts a whole frame before anything of it is used, so that an error leaves everything as it was. Observations are
/// taken in the order of their time stamps, those without one where they stand. `has_action`: the frame's motion is
/// known from its actions; readings of odometry then only say where the next increment begins. A reading older than the
/// last one is passed over.
FrameInput convert_frame(const mrpt::obs::CSensoryFrame& frame, bool has_action, const MotionState& before,
                         const MapBuilderOptions& options);

}  // namespace helixnav::mrpt_adapter
