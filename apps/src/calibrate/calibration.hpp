// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "helixnav/logs/vehicle.hpp"
#include "helixnav/smoothing/noise_scales.hpp"
#include "kept_constants.hpp"
#include "settings/settings.hpp"
#include "vehicle_constants.hpp"

namespace helixnav::apps {

/// A constant as estimated, with all of them free. `value` is the best one whether it is kept or not.
struct ConstantFound {
  VehicleConstant constant;
  double told = 0.0;  ///< by the vehicle file
  double value = 0.0;
  double sigma = 0.0;  ///< of value; if nothing is observable: the uncertainty after the log
  bool observable = false;
  Verdict verdict = Verdict::not_observable;
  double kept_value = 0.0;  ///< estimated with the constants that are not kept at their file values
  double kept_sigma = 0.0;  ///< likewise; 0 if not kept

  bool kept() const { return verdict == Verdict::kept; }
};

struct Calibration {
  smoothing::NoiseScales scales;  ///< on what the vehicle file assumes
  std::vector<ConstantFound> constants;
  std::size_t first_closings = 0;  ///< of the run with everything as assumed
  std::size_t closings = 0;        ///< of the last
  int rounds = 0;
  bool settled = false;
  std::size_t observations = 0, used = 0;  ///< in the last round
  std::size_t slips = 0;                   ///< of the last round; noise of the odometry is not estimated from them
  int undetermined =
      0;  ///< landmarks, or passages of them, left out in the last round: bearings do not fix their place
  bool without_returns = false;  ///< landmarks seen again after a while were taken for new ones

  double held_out_gain = 0.0;  ///< ln L of the parts, each with the constants fitted to the others, over file values
  double nis_told = 0.0, nis_found = 0.0;  ///< per degree of freedom in the last part, with the noise found
  Settings settings;                       ///< with what is kept
};

/// Navigates with what is known, fits constants and noise to the drive solved as a whole, and repeats until nothing
/// changes; prints a line for each round. Errors as for drive_through(); InputError if no noise can be judged.
Calibration calibrate_log(const std::string& path, const Settings& settings, const logs::Vehicle& vehicle);

}  // namespace helixnav::apps
