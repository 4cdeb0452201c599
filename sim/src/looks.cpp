// SPDX-License-Identifier: BSD-3-Clause
#include "looks.hpp"

#include <algorithm>
#include <string>

namespace helixnav::sim {

core::Appearance Looks::of(const Tree& tree) {
  constexpr double least_error = 0.001;
  constexpr double least_size_m = 0.01;
  core::Appearance seen;
  if (options_.classes > 0) {
    int kind = static_cast<int>(tree.class_draw * options_.classes);
    if (options_.classes > 1 && random_.bernoulli(options_.class_error)) {
      const int away = 1 + static_cast<int>(random_.below(static_cast<std::uint64_t>(options_.classes - 1)));
      kind = (kind + away) % options_.classes;
    }
    seen.name = core::ClassName("class_" + std::to_string(kind));
    seen.class_error = std::max(least_error, options_.class_error);
  }
  if (options_.sigma_size_m > 0.0) {
    const Interval& diameter_m = options_.diameter_m;
    const double true_m = diameter_m.min + tree.diameter_draw * (diameter_m.max - diameter_m.min);
    seen.size_m = std::max(least_size_m, random_.normal(true_m, options_.sigma_size_m));
    seen.sigma_size_m = options_.sigma_size_m;
  }
  return seen;
}

core::Appearance Looks::of_clutter() {
  if (options_.classes == 0 && options_.sigma_size_m == 0.0) return {};
  Tree any;
  any.class_draw = random_.uniform(0.0, 1.0);
  any.diameter_draw = random_.uniform(0.0, 1.0);
  return of(any);
}

}  // namespace helixnav::sim
