// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/logs/read_recording.hpp"
#include "settings/settings.hpp"

namespace helixnav::apps {

/// A constant of a vehicle file that is applied in reading a log, and that may be wrong.
struct VehicleConstant {
  std::string key;     ///< in the file, with its unit
  std::string stem;    ///< without the unit
  int sensor = -1;     ///< index of the [[sensor]]; −1: [odometry]; `every_sensor`
  double unit = 1.0;   ///< of the file in internal units: radians, seconds, metres
  double usual = 0.0;  ///< how far files are usually off: the prior standard deviation
  double nudge =
      0.0;  ///< a change for computing the derivatives; 0: for a delay, which moves the sensors along the path
  double least = 0.0, most = 0.0;  ///< range allowed in the file
  std::function<std::vector<double*>(Settings&)> places;
  /// The share of an increment (x, y, heading) that it multiplies, and of its error, too.
  Eigen::Vector3d factor_of = Eigen::Vector3d::Zero();

  static constexpr int every_sensor = -2;

  double value(const Settings& settings) const;
  void add(Settings& settings, double change) const;  ///< to every place
};

/// Those of a log of this format: the user's own, and ACFR's truck; others have none. A lever arm is usually wrong by a
/// fiftieth of the reach.
std::vector<VehicleConstant> constants_of(const Settings& settings, logs::LogFormat format,
                                          const logs::Vehicle& vehicle, double reach_m);

}  // namespace helixnav::apps
