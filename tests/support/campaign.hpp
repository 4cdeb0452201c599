// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "helixnav/core/chi2.hpp"
#include "sanitized.hpp"

/// Statistics over many drives. Suites of such tests are named …Campaign, which gives them the CTest label `campaign`.
namespace helixnav::support {

/// Runs of a campaign: `whole` of them, but one under a sanitizer, which checks the code that a single drive goes
/// through; the figures are judged in a fast build. The caller takes the band for this number of runs from below.
inline int campaign_runs(int whole) { return sanitized ? 1 : whole; }

/// Whether the campaign has all its runs, for what one run cannot show, such as one mean being above another.
inline constexpr bool whole_campaign = !sanitized;

/// Their seeds: first, first + 1, …
inline std::vector<std::uint64_t> campaign_seeds(std::uint64_t first, int whole) {
  std::vector<std::uint64_t> seeds;
  for (int run = 0; run < campaign_runs(whole); ++run) seeds.push_back(first + static_cast<std::uint64_t>(run));
  return seeds;
}

struct Band {
  double low = 0.0;
  double high = 0.0;
};

/// The band that the sum of `runs` independent χ² values of `dof` degrees of freedom leaves with probability
/// `false_alarm`, half of it on either side.
inline Band chi2_band(int runs, int dof, double false_alarm) {
  return {core::chi2_quantile(0.5 * false_alarm, runs * dof), core::chi2_quantile(1.0 - 0.5 * false_alarm, runs * dof)};
}

/// The narrowest band of integers that the number of successes in `runs` independent runs, each of probability `rate`,
/// leaves with probability at most `false_alarm` / 2 on either side.
inline Band count_band(int runs, double rate, double false_alarm) {
  const auto probability = [&](int count) {
    const double ways = std::lgamma(runs + 1.0) - std::lgamma(count + 1.0) - std::lgamma(runs - count + 1.0);
    return std::exp(ways + count * std::log(rate) + (runs - count) * std::log1p(-rate));
  };
  int low = 0;
  for (double below = probability(0); below <= 0.5 * false_alarm; below += probability(low)) ++low;
  int high = runs;
  for (double above = probability(runs); above <= 0.5 * false_alarm; above += probability(high)) --high;
  return {static_cast<double>(low), static_cast<double>(high)};
}

}  // namespace helixnav::support
