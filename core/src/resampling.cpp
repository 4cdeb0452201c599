// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/resampling.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {

double normalise(std::vector<double>& log_weight) {
  double largest = -HUGE_VAL;
  for (const double lw : log_weight) {
    if (std::isnan(lw)) throw NumericalError("particle filter: a weight is NaN");
    largest = std::max(largest, lw);
  }
  if (!std::isfinite(largest)) throw NumericalError("particle filter: no particle has a finite weight");
  double sum = 0.0;
  for (const double lw : log_weight) sum += std::exp(lw - largest);
  const double log_sum = largest + std::log(sum);
  for (double& lw : log_weight) lw -= log_sum;
  return log_sum;
}

double effective_sample_size(const std::vector<double>& log_weight) {
  double squares = 0.0;
  for (const double lw : log_weight) squares += std::exp(2.0 * lw);
  return 1.0 / squares;
}

void systematic_parents(const std::vector<double>& log_weight, std::size_t m, double offset,
                        std::vector<std::uint32_t>& parents) {
  parents.clear();
  double reached = 0.0;
  std::uint32_t heaviest = 0;
  for (std::size_t i = 0; i < log_weight.size() && parents.size() < m; ++i) {
    reached += std::exp(log_weight[i]) * static_cast<double>(m);
    if (log_weight[i] > log_weight[heaviest]) heaviest = static_cast<std::uint32_t>(i);
    while (static_cast<double>(parents.size()) + offset < reached && parents.size() < m) {
      parents.push_back(static_cast<std::uint32_t>(i));
    }
  }
  while (parents.size() < m) parents.push_back(parents.empty() ? heaviest : parents.back());  // round-off at the end
}

}  // namespace helixnav::core
