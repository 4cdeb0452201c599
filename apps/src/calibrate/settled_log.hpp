// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "helixnav/core/recording.hpp"
#include "helixnav/smoothing/constants.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "helixnav/smoothing/robust_kernel.hpp"
#include "settled_drive.hpp"
#include "vehicle_constants.hpp"

namespace helixnav::apps {

/// Reads the log by the settings, with the noise as known.
using ReadLog = std::function<core::Recording(const Settings&)>;

/// Associations within one passage alone: a landmark unseen for a while becomes a new one when it is seen again. Drift
/// makes a drive return to the wrong landmarks; landmarks next to each other are still told apart.
Ids without_returns(const Ids& ids);

/// Associations except those that a solved task contradicts: squared residual, by its covariance, more than 15 times the median.
Ids without_outliers(const Ids& ids, const SmoothingTask& solved);

/// From a good start, until no further gain above this is expected [χ²]; throws Interrupted on SIGINT. A drive along an open road
/// creeps to its minimum in 100 steps and more, the last half of which gain 1e-4 of a χ² of 20 000.
smoothing::Options patient_solver(double tolerance_chi2);

/// The least-squares problem of a log read with the settings, with the associations of a drive through it, solved from the drive's
/// estimate. An observation of a landmark that ends up inside the sensor is left out (edge_of −1), and so are all of a landmark whose
/// place is left open by bearings from nearly one side (smoothing::hardly_determined_landmarks); these are counted.
/// Test: apps/calibrate/settled_log_test.cpp
SmoothingTask solve_log(const core::Recording& recording, Ids ids, const core::LandmarkGraph& from,
                        const smoothing::RobustKernel& kernel = {});

/// The measurements of a log between its scans and at them.
struct MotionsAndMountings {
  std::vector<core::Nanoseconds> times;       ///< [scan]
  std::vector<core::Pose2> moved;             ///< [scan] since the scan before
  std::vector<core::Pose2> mounting;          ///< [scan]
  std::vector<std::vector<double>> ranges_m;  ///< [scan][observation], 0 if bearing-only
};

/// Whether two readings contain the same measurements.
bool same(const MotionsAndMountings& a, const MotionsAndMountings& b);

/// A log read once as in the file and once more for every constant, with that one nudged.
struct NudgedLog {
  MotionsAndMountings told;
  std::vector<MotionsAndMountings> nudged;  ///< [constant]; empty for a delay
  std::vector<VehicleConstant> constants;
  std::vector<double> values;  ///< [constant] as in the file
};
NudgedLog nudge(const ReadLog& read, const Settings& settings, const std::vector<VehicleConstant>& constants,
                const core::Recording& told);

/// The derivatives of a solved task's measurements by the constants. Factors multiply the error of an increment, too, and a
/// delay acts through the speed: both are taken from the solution, whose errors are independent of the measurement residuals;
/// taken from the measured increments, they would bias the constant (a noisy regressor). And a delay shifts the sensor along the
/// path rather than the ends of the increments: if these cut a sample in two, its noise averages out, which least squares takes
/// for a better fit. The speed is that of drifting_level(): on a steady drive, the noise of the solved poses would be all that
/// changes, and each step of a fit would go in a random direction.
std::vector<smoothing::ConstantDerivative> derivatives_of(const NudgedLog& log, const SmoothingTask& task);

}  // namespace helixnav::apps
