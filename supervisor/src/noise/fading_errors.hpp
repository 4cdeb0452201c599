// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace helixnav::supervisor {

/// Squared normalised errors of two degrees of freedom each, fading exponentially, by a histogram of their logarithm. The
/// scale is the median's ratio to that of χ²₂: a third of wrong pairs moves it little, a mean would follow the largest.
/// Test: supervisor/noise/fading_errors_test.cpp.
class FadingErrors {
 public:
  /// Sums fade by `keep` a scan.
  explicit FadingErrors(double keep) : keep_(keep) {}

  void fade();
  void add(double squared, double weight);

  double weight() const { return weight_; }

  /// Factor on the variance that was assumed; 1 without errors.
  double scale() const;

  /// The same by the mean of errors that are no outliers under what was assumed: larger than scale() where tails are heavy.
  double mean_scale() const { return weight_ > 0.0 ? 0.5 * sum_ / weight_ : 1.0; }

  /// Standard deviation of ln scale().
  double log_sigma() const;

 private:
  static constexpr int bins_an_octave = 4;
  static constexpr int least_octave = -12;
  static constexpr std::size_t bins = 28 * bins_an_octave;

  static double lower_edge(std::size_t bin);

  double keep_;
  double weight_ = 0.0;
  double sum_ = 0.0;  ///< of errors, each bounded
  std::array<double, bins> weights_{};
};

}  // namespace helixnav::supervisor
