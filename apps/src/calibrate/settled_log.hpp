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

/// Associations within one passage alone: a landmark unseen for a while is another one when it is seen again. What drifts
/// makes a drive return to the wrong landmarks; beside each other they are told apart all the same.
Ids without_returns(const Ids& ids);

/// Associations but for those that a solved task contradicts: whose squared residual, by its covariance, is 15 times the median.
Ids without_outliers(const Ids& ids, const SmoothingTask& solved);

/// From a start that is good, until no more than this is promised [χ²]; Interrupted from it on SIGINT. A drive along an open road
/// creeps to its minimum in 100 steps and more, of which the last halves are worth 1e-4 of a χ² of 20 000.
smoothing::Options patient_solver(double tolerance_chi2);

/// The least-squares problem of a log read by the settings, with the associations of a drive through it, solved from where
/// the drive stands. An observation of a landmark that comes to stand in the sensor is left out (edge_of −1), and so are all of a landmark
/// whose place bearings from nearly one side leave open (smoothing::hardly_determined_landmarks), which are counted. Test:
/// apps/calibrate/settled_log_test.cpp
SmoothingTask solve_log(const core::Recording& recording, Ids ids, const core::LandmarkGraph& from,
                        const smoothing::RobustKernel& kernel = {});

/// What a log measures between its scans and at them.
struct MotionsAndMountings {
  std::vector<core::Nanoseconds> times;       ///< [scan]
  std::vector<core::Pose2> moved;             ///< [scan] since the scan before
  std::vector<core::Pose2> mounting;          ///< [scan]
  std::vector<std::vector<double>> ranges_m;  ///< [scan][observation], 0 of a bearing alone
};

/// Whether two readings measure the same.
bool same(const MotionsAndMountings& a, const MotionsAndMountings& b);

/// A log read once as told and once more for every constant, that changed by its nudge.
struct NudgedLog {
  MotionsAndMountings told;
  std::vector<MotionsAndMountings> nudged;  ///< [constant]; empty of a delay
  std::vector<VehicleConstant> constants;
  std::vector<double> values;  ///< [constant] as told
};
NudgedLog nudge(const ReadLog& read, const Settings& settings, const std::vector<VehicleConstant>& constants,
                const core::Recording& told);

/// The derivatives of a solved task's measurements by the constants. Factors multiply the error of an increment, too, and a
/// delay acts through the speed: both are taken of the solution, whose errors have nothing to do with what is left of the
/// measurements; of the increments measured, they would pull the constant (a noisy regressor). And a delay is the sensor's place
/// along the path rather than other ends of the increments: where these cut a sample in two, its noise averages out, which
/// least squares takes for a better fit. The speed is that of drifting_level(): of a steady drive the noise of the solved poses
/// would be all that changes, and each step of a fit would go where it happens to point.
std::vector<smoothing::ConstantDerivative> derivatives_of(const NudgedLog& log, const SmoothingTask& task);

}  // namespace helixnav::apps
