// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"
#include "noise/fading_errors.hpp"
#include "noise/repeated_errors.hpp"
#include "slip/relative_geometry.hpp"

namespace helixnav::supervisor {

/// One look at a landmark.
struct Look {
  core::LandmarkId id = core::no_landmark;
  bool is_new_side = false;  ///< from another side than when it last counted
  bool is_fair = true;       ///< its error could have been as large as the noise is believed to be (see NoisePair)
};

/// Factors on the covariances that odometry and detector claim, learnt from where landmarks are seen. The innovation of
/// three or more pairs splits into what a displacement of the vehicle explains (3 degrees of freedom, wᵀw with
/// w ~ N(0, I)) and the rest, in which odometry has no part: the rest gives the detector's factor, and odometry's share
/// of w gives odometry's.
///
/// Up: every scan counts, and of w only what is not constant. A mean over many scans is a bias (a wheel's radius, a
/// wrong scale of ranges) and not noise; otherwise DLR's forward motion, 8 % too long against its detector, would pass
/// for four times the variance. Down: the detector's factor also needs independent errors, of landmarks seen from
/// another side than when they last counted, sums of eight looks that are as small, and displacements that odometry explains;
/// odometry's needs all of w. Errors that could not have been larger, of posts in a row, say nothing of that. Rules and figures: docs/noise.md. Test: supervisor/noise/noise_scale_test.cpp.
class NoiseScale {
 public:
  /// One scan while nothing is in question; Q: the covariance of the motion before it (x, y, heading; robot frame); the look
  /// of each pair, by a vehicle of this heading.
  void observe(const PairEquations& pairs, const std::vector<Look>& looks, double heading_rad,
               const Eigen::Matrix3d& Q);

  double odometry() const { return odometry_; }          ///< factor on covariances
  double observations() const { return observations_; }  ///< factor on covariances

  /// The factors that the whole drive was processed with; 1 at its start.
  double applied_odometry = 1.0;
  double applied_observations = 1.0;

 private:
  /// Odometry's share of displacements, fading; the factors that were in force are multiplied back.
  struct Displacements {
    double keep;
    double sum = 0.0;
    double weight = 0.0;
    double shares = 0.0;

    void add(double nis, double share, double detector, double in_force);
    double scale() const;
    double sigma() const;  ///< of scale(), where it is 1

    /// The scale if it is above 1 by so many deviations, else 1, however small odometry's share: what the detector's factor leaves
    /// open (`log_sigma` of it) counts as often as its part in the displacements is larger.
    double sure_rise(double sigmas, double log_sigma) const;
  };

  void add_rest(const PairEquations& pairs, const Eigen::Vector3d& displacement, const Eigen::Matrix3d& information,
                const std::vector<Look>& looks, double heading_rad);
  void add_displacement(const Eigen::Vector3d& w, double share);
  void add_fair_displacement(const Eigen::Vector3d& w, double share);
  double detector_seen() const;
  bool motion_is_as_assumed_at_most() const;
  double detector_factor() const;
  double odometry_factor() const;
  double hidden_rise(double sigmas) const;

  FadingErrors slow_{1.0 - 1.0 / 300.0};
  FadingErrors quick_{1.0 - 1.0 / 60.0};
  FadingErrors new_sides_{1.0 - 1.0 / 1000.0};
  RepeatedErrors repeated_;
  Displacements slow_motion_{1.0 - 1.0 / 1000.0};
  Displacements quick_motion_{1.0 - 1.0 / 60.0};
  Displacements biased_motion_{1.0 - 1.0 / 1000.0};
  Displacements fair_motion_{1.0 - 1.0 / 1000.0};   ///< the same of fair pairs only
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();  ///< of w
  double mean_weight_ = 20.0;                       ///< weight, in scans, of the belief that there is no bias
  double odometry_ = 1.0;
  double observations_ = 1.0;
};

}  // namespace helixnav::supervisor
