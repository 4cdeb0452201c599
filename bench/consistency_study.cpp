// SPDX-License-Identifier: BSD-3-Clause
//
// Is the filter consistent? 100 runs each of sim's circuit and circuit-large-noise, association known, assumed noise
// = true noise, default region. Prints per retraction:
//   NEES     mean 3-dof NEES of the pose over the last quarter; 95 % band for 100 runs 2.54 … 3.50
//   NIS/dof  sum of the NIS of all joint updates of all runs over the sum of their degrees of freedom, and its 95 % band
//   inside   share of the updates whose NIS is inside the two-sided 95 % band of its own χ²
// usage: helixnav_consistency_study [first seed]
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "scenario_study.hpp"

int main(int argc, char** argv) {
  using namespace helixnav::cekf;
  const std::uint64_t first_seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 730001;
  std::printf("seeds %llu ... %llu\n", static_cast<unsigned long long>(first_seed),
              static_cast<unsigned long long>(first_seed + 99));
  std::printf("%-20s %-16s %6s %9s  %-18s %8s\n", "scenario", "retraction", "NEES", "NIS/dof", "95 % band", "inside");
  for (const char* scenario : {"circuit", "circuit-large-noise"}) {
    for (const auto retraction : {Retraction::right_invariant, Retraction::standard}) {
      FilterOptions options;
      options.retraction = retraction;
      const StudySums sums = drive_scenario(scenario, options, first_seed, 100);
      const double half_band = 1.96 * std::sqrt(2.0 / sums.nis_dof);
      std::printf("%-20s %-16s %6.2f %9.4f  %.4f ... %.4f %7.2f %%\n", scenario,
                  retraction == Retraction::standard ? "standard" : "right_invariant", sums.mean_nees(),
                  sums.nis_per_dof(), 1.0 - half_band, 1.0 + half_band, 100.0 * sums.share_inside());
      std::fflush(stdout);
    }
  }
  return 0;
}
