// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace helixnav::supervisor {

/// Squared normalised errors of two degrees of freedom each, fading exponentially, as a histogram of their logarithm.
/// The scale is the ratio of their median to that of χ²₂: a third of wrong pairs moves it little, whereas a mean would
/// follow the largest. Test: supervisor/noise/fading_errors_test.cpp.
class FadingErrors {
 public:
  /// Sums fade by the factor `keep` per scan.
  explicit FadingErrors(double keep) : keep_(keep) {}

  void fade();
  void add(double squared, double weight);

  double weight() const { return weight_; }

  /// Factor on the assumed variance; 1 without errors.
  double scale() const;

  /// The same from the mean of errors that are not outliers under the assumed noise: larger than scale() if tails are
  /// heavy.
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
