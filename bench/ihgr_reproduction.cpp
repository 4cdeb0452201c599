// SPDX-License-Identifier: BSD-3-Clause
//
// The simulation of ihgr_zhang2005 §IV.A for every method, swept over what the paper leaves open, as CSV on stdout: one
// row per method and world, shares of successful runs with 95 % intervals (Wilson). docs/ihgr.md shows it.
//   helixnav_ihgr_reproduction [layouts, default 200 [setting, default all]]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "ihgr_study.hpp"

namespace {

using namespace helixnav;

constexpr double degrees = core::pi / 180.0;

struct Setting {
  std::string name;
  sim::IhgrCircle world;
};

std::vector<Setting> settings() {
  Setting half{"half circle", {}};
  Setting full{"full circle", {}};
  full.world.field_of_view.min_bearing_rad = -core::pi;
  full.world.field_of_view.max_bearing_rad = core::pi;
  Setting narrow{"half circle to 10 m", {}};
  narrow.world.field_of_view.max_range_m = 10.0;
  Setting drift{"half circle, odometry x3", {}};
  drift.world.sigma_distance_m *= 3.0;
  drift.world.sigma_turn_rad *= 3.0;
  Setting close{"half circle, close features", {}};
  close.world.close_features = true;
  return {half, full, narrow, drift, close};
}

struct Interval {
  double share;
  double low;
  double high;
};

Interval wilson(int good, int all) {
  constexpr double z = 1.96;
  const double n = all;
  const double p = good / n;
  const double middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  return {p, middle - half, middle + half};
}

void print_row(const Setting& setting, const bench::Contestant& contestant, int layouts) {
  int without_wrong = 0;
  int consistent = 0;
  int one_each = 0;
  evaluation::AssociationScore score;
  for (int layout = 0; layout < layouts; ++layout) {
    const bench::Verdict verdict =
        bench::run_layout(setting.world, static_cast<std::uint64_t>(layout) + 1, contestant.mapping);
    without_wrong += verdict.without_wrong;
    consistent += verdict.consistent;
    one_each += verdict.one_landmark_each;
    score += verdict.score;
  }
  std::printf("\"%s\",%g,\"%s\",%d", setting.name.c_str(), setting.world.sigma_range_m, contestant.name.c_str(),
              layouts);
  for (const int good : {without_wrong, consistent, one_each}) {
    const Interval share = wilson(good, layouts);
    std::printf(",%.4f,%.4f,%.4f", share.share, share.low, share.high);
  }
  std::printf(",%zu,%zu,%zu\n", score.wrong, score.missed, score.labelled);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int layouts = argc > 1 ? std::atoi(argv[1]) : 200;
  if (layouts < 1) {
    std::fprintf(stderr, "usage: %s [layouts [setting]]\n", argv[0]);
    return 2;
  }
  std::printf(
      "setting,sigma_range_m,method,layouts,no_wrong,no_wrong_low,no_wrong_high,consistent,consistent_low,"
      "consistent_high,one_each,one_each_low,one_each_high,wrong,missed,observations\n");
  for (const Setting& setting : settings()) {
    if (argc > 2 && setting.name != argv[2]) continue;
    for (const double sigma_range_m : {0.03, 0.06, 0.1, 0.15, 0.2, 0.3}) {
      Setting noisy = setting;
      noisy.world.sigma_range_m = sigma_range_m;
      noisy.world.sigma_bearing_rad = 10.0 * sigma_range_m * degrees;  // 0.1 m goes with 1°
      for (const bench::Contestant& contestant : bench::ihgr_contestants()) print_row(noisy, contestant, layouts);
    }
  }
}
