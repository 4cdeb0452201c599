// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "index/parts.hpp"

namespace helixnav::relocalize {

namespace {

constexpr double units_a_metre = 1e4;

}  // namespace

void Appearances::count(const Landmark& landmark, int sign) {
  if (landmark.kind) {
    kinds[*landmark.kind] += sign;
    with_kind += sign;
  }
  if (landmark.size) {
    const auto units = static_cast<std::int64_t>(std::llround(landmark.size->mean_m * units_a_metre));
    sum += sign * units;
    sum_of_squares += sign * units * units;
    with_size += sign;
  }
}

double Appearances::kind_share(int kind) const {
  const auto known = kinds.find(kind);
  const double seen = known == kinds.end() ? 0.0 : static_cast<double>(known->second);
  return (seen + 1.0) / (static_cast<double>(with_kind) + static_cast<double>(kinds.size()) + 1.0);
}

double Appearances::size_mean_m() const {
  return static_cast<double>(sum) / static_cast<double>(with_size) / units_a_metre;
}

double Appearances::size_variance_m2() const {
  const double n = static_cast<double>(with_size);
  const double mean = static_cast<double>(sum) / n;
  return std::max(0.0, static_cast<double>(sum_of_squares) / n - mean * mean) / (units_a_metre * units_a_metre);
}

}  // namespace helixnav::relocalize
