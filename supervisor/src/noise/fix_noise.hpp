// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "helixnav/core/time.hpp"

namespace helixnav::supervisor {

/// Innovation of a fix and the variance of what was predicted, per coordinate, with the fix's covariance factored out.
struct FixInnovation {
  Eigen::Vector2d innovation = Eigen::Vector2d::Zero();
  double predicted_variance = 0.0;
};

/// How the errors of absolute fixes behave, learnt from their innovations. The error of one fix is a white part and a part
/// that fades with a time constant τ (multipath, the ionosphere); both may be of another size than stated. 83 hypotheses about τ
/// and the two sizes are weighed by how well each predicts the next innovation. In each, a Kalman filter per
/// axis estimates the fading error beside the error of the pose itself, whose variance the estimator states; without the
/// latter, a pose still to be corrected would look like fixes that err alike.
///
/// Fixes that err alike for τ are worth one fix every 2τ: an estimator that knows only white errors has to be given each
/// of them with (1 + φ)/(1 − φ) times its variance, φ = exp(−dt/τ), which is the integral of the autocorrelation.
/// Equations and figures: docs/noise.md. Test: supervisor/noise/fix_noise_test.cpp.
class FixNoise {
 public:
  FixNoise();

  /// Before the fix is used. A fix beyond the gate `most_nis` teaches nothing, as a burst of outliers, unless most of
  /// the last ones were: then it is not they that are wrong.
  void observe(const FixInnovation& fix, double most_nis, core::Nanoseconds t_ns);

  /// After it was used: its innovation before and now.
  void note_correction(const FixInnovation& before, const FixInnovation& after);

  /// The pose was corrected by something else: by how much is not known.
  void forget_offset();

  /// Factors on the covariance that a fix states, at least 1: of its own error, and for an update that takes it for independent
  /// of the others.
  double of_one() const { return of_one_; }
  double in_update() const { return in_update_; }

  double applied = 1.0;  ///< in_update() that the whole drive was processed with

 private:
  struct Hypothesis {
    double fading_s = 0.0;
    double white = 1.0;  ///< variances, in units of the stated one
    double fading = 0.0;
    double log_prior = 0.0;
    double log_likelihood = 0.0;                           ///< of the last fixes
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of fading error and offset of the pose, per coordinate
    Eigen::Matrix2d means = Eigen::Matrix2d::Zero();       ///< [fading error, offset] × coordinate
  };

  void predict(Hypothesis& hypothesis, double elapsed_s, double drifted) const;
  void update(Hypothesis& hypothesis, const Eigen::Vector2d& innovation, double keep) const;
  void weigh();

  std::array<Hypothesis, 83> hypotheses_;
  bool begun_ = false;
  double beyond_ = 0.0;  ///< share of the last fixes that were beyond their gate
  core::Nanoseconds last_ns_ = 0;
  double interval_s_ = 0.0;  ///< usual time between two fixes
  double variance_ = 0.0;    ///< of the pose after the last fix
  double of_one_ = 1.0;
  double in_update_ = 1.0;
};

}  // namespace helixnav::supervisor
