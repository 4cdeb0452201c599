// SPDX-License-Identifier: BSD-3-Clause
//
// Scans with far more observations than any sensor produces, several in a row: processor time of each, peak resident
// memory, observations used. A table; exits with status 1 if a scan of 10 000 takes more than 1 s or 200 MB.
//   helixnav_full_scan
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "measures.hpp"

namespace {

using namespace helixnav;

constexpr double reach_m = 80.0;

/// The same places each time, seen with noise; one_place: all observations are of a single one.
core::Scan scan_of(std::size_t observations, bool one_place, core::Nanoseconds t_ns, core::RandomStream& noise) {
  core::RandomStream places(5);
  core::Scan scan;
  scan.t_ns = t_ns;
  scan.field_of_view = {0.5, reach_m, -core::pi, core::pi};
  for (std::size_t i = 0; i < observations; ++i) {
    const double range_m = one_place ? 20.0 : reach_m * std::sqrt(places.uniform(0.01, 0.95));
    const double bearing_rad = one_place ? 0.5 : places.uniform(-3.1, 3.1);
    scan.observations.push_back(
        core::make_range_bearing(noise.normal(range_m, 0.1), noise.normal(bearing_rad, 0.01), 0.1, 0.01));
  }
  return scan;
}

/// True when every scan took at most a second.
bool drive(std::size_t observations, bool one_place) {
  supervisor::NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  supervisor::Navigator navigator({}, options);
  core::RandomStream noise(1);
  std::printf("%8zu %-10s", observations, one_place ? "one place" : "everywhere");
  double most_s = 0.0;
  std::size_t used = 0;
  for (core::Nanoseconds i = 0; i < 5; ++i) {
    core::Odometry still;
    still.t_ns = i * 100'000'000;
    still.covariance = 1e-6 * Eigen::Matrix3d::Identity();
    const core::Scan scan = scan_of(observations, one_place, still.t_ns, noise);
    const double begin_s = bench::seconds_of_this_thread();
    navigator.move(still);
    const core::StepReport report = navigator.observe(scan);
    const double took_s = bench::seconds_of_this_thread() - begin_s;
    most_s = std::max(most_s, took_s);
    used = 0;
    for (const core::AssociationReport& one : report.associations) used += one.outcome != core::Outcome::ambiguous;
    std::printf(" %8.1f", 1e3 * took_s);
    std::fflush(stdout);
  }
  std::printf(" %6zu %8.1f\n", used, bench::peak_mb());
  return most_s <= 1.0;
}

}  // namespace

int main() {
  std::printf("observations           ms of scan 1      2        3        4        5   used  peak MB\n");
  bool good = true;
  for (const std::size_t observations : {10, 100, 256, 1000, 10'000}) {
    for (const bool one_place : {false, true}) good = drive(observations, one_place) && good;
  }
  good = good && bench::peak_mb() <= 200.0;
  drive(50'000, false);
  return good ? 0 : 1;
}
