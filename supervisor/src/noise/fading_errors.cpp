// SPDX-License-Identifier: BSD-3-Clause
#include "noise/fading_errors.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::supervisor {

double FadingErrors::lower_edge(std::size_t bin) {
  return std::exp2(least_octave + static_cast<double>(bin) / bins_an_octave);
}

void FadingErrors::fade() {
  weight_ *= keep_;
  sum_ *= keep_;
  for (double& weight : weights_) weight *= keep_;
}

void FadingErrors::add(double squared, double weight) {
  const double octave = std::log2(std::max(squared, lower_edge(0))) - least_octave;
  const double last = static_cast<double>(bins - 1);
  weights_[static_cast<std::size_t>(std::clamp(octave * bins_an_octave, 0.0, last))] += weight;
  weight_ += weight;
  constexpr double outlier = 13.8;  // χ²₂ of 99.9 %
  sum_ += weight * std::min(squared, outlier);
}

double FadingErrors::scale() const {
  if (!(weight_ > 0.0)) return 1.0;
  constexpr double median_of_chi2_2 = 1.3862943611198906;  // 2 ln 2
  const double half = 0.5 * weight_;
  double below = 0.0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (below + weights_[bin] >= half) {
      const double share = (half - below) / weights_[bin];
      return lower_edge(bin) * std::exp2(share / bins_an_octave) / median_of_chi2_2;
    }
    below += weights_[bin];
  }
  return lower_edge(bins) / median_of_chi2_2;
}

/// A median of n has variance 1/(4 n f²) with density f there; for ln χ²₂, f = ln 2 / 2.
double FadingErrors::log_sigma() const { return 1.0 / (std::log(2.0) * std::sqrt(weight_)); }

}  // namespace helixnav::supervisor
