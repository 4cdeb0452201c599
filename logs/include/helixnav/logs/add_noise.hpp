// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"

namespace helixnav::logs {

/// The numbers of a log that noise can be added to: odometry increments (robot frame, x ahead and y left), points of
/// Cartesian observations (sensor frame), ranges and bearings of all observation kinds that have them.
enum class NoiseField { odometry_x, odometry_y, odometry_heading, point_x, point_y, range, bearing };

/// "odometry_x_m", "odometry_y_m", "odometry_heading_rad", "point_x_m", "point_y_m", "range_m", "bearing_rad".
std::string name_of(NoiseField field);
std::vector<NoiseField> noise_fields();

struct Noise {
  NoiseField field = NoiseField::odometry_x;
  double sigma = 0.0;  ///< in the unit of the field's name
};

/// What was drawn for one field.
struct AddedNoise {
  NoiseField field = NoiseField::odometry_x;
  double sigma = 0.0;
  std::size_t count = 0;        ///< how many numbers were changed
  double measured_sigma = 0.0;  ///< √(Σ drawn² / count): the mean is known to be 0
  double low_99 = 0.0;          ///< two-sided 99 % interval of `measured_sigma`
  double high_99 = 0.0;
};

/// Adds independent N(0, sigma²) to every number of the named fields, and sigma² to its variance in the log, so that
/// the covariances stay as right (or wrong) as they were. Each field has its own random stream, seeded from `seed` and
/// its name: noise on one field leaves that of the others unchanged. Headings and bearings are wrapped. Throws
/// InputError, leaving the recording unchanged, when the log has no such field, a field is named twice, a sigma is not
/// positive and finite, or a range would no longer be positive. Test: logs/add_noise_test.cpp (99 % interval of the
/// standard deviation, independence of fields, same seed same bytes).
std::vector<AddedNoise> add_noise(core::Recording& recording, const std::vector<Noise>& noises, std::uint64_t seed);

}  // namespace helixnav::logs
