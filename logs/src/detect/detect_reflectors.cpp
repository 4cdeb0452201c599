// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/detect_reflectors.hpp"

#include <cstddef>

#include "helixnav/core/angle.hpp"

namespace helixnav::logs {
namespace {

/// Bright beams of one pole, as sums.
struct Run {
  int last_beam = 0;
  int beams = 0;
  int sum_of_beams = 0;
  double sum_of_ranges_m = 0.0;
};

SickDetection describe(const Run& run, const ReflectorRules& rules) {
  SickDetection pole;
  pole.diameter_m = rules.pole_diameter_m;
  pole.beams_hit = run.beams;
  pole.range_m = run.sum_of_ranges_m / run.beams + rules.pole_diameter_m / 2.0;
  pole.bearing_rad = run.sum_of_beams * core::pi / 360.0 / run.beams - core::pi / 2.0;
  return pole;
}

}  // namespace

std::vector<SickDetection> detect_reflectors(const SickScan& scan, const ReflectorRules& rules) {
  std::vector<SickDetection> poles;
  Run run;
  for (int beam = 0; beam < SickScan::beams; ++beam) {
    const auto k = static_cast<std::size_t>(beam);
    const double range_m = scan.range_cm[k] / 100.0;
    if (scan.reflectivity[k] < rules.min_reflectivity || range_m >= rules.max_range_m) {
      continue;
    }
    if (run.beams > 0 && beam - run.last_beam > rules.max_gap_beams) {
      poles.push_back(describe(run, rules));
      run = Run{};
    }
    run.last_beam = beam;
    run.beams += 1;
    run.sum_of_beams += beam;
    run.sum_of_ranges_m += range_m;
  }
  if (run.beams > 0) {
    poles.push_back(describe(run, rules));
  }
  return poles;
}

}  // namespace helixnav::logs
