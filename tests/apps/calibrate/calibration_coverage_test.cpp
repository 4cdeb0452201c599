// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "program.hpp"
#include "spoilt_log.hpp"

namespace helixnav::apps {
namespace {

struct Interval {
  double middle = 0.0, low = 0.0, high = 0.0;
};

/// What calibrate prints about what it could observe: constants "KEY given A found B +- C", noise "KIND noise x B (95 %: LOW to HIGH".
std::map<std::string, Interval> table_of(const std::string& text) {
  std::map<std::string, Interval> table;
  const std::regex constant(R"((\w+) +given +\S+ +found +(\S+) \+- (\S+) +observable)");
  for (std::sregex_iterator row(text.begin(), text.end(), constant), end; row != end; ++row) {
    const double value = std::stod((*row)[2]), half = std::stod((*row)[3]);
    table[(*row)[1]] = {value, value - half, value + half};
  }
  const std::regex noise(R"((\w+) +noise x (\S+) \(95 %: (\S+) to ([\d.]+))");
  for (std::sregex_iterator row(text.begin(), text.end(), noise), end; row != end; ++row)
    table[(*row)[1]] = {std::stod((*row)[2]), std::stod((*row)[3]), std::stod((*row)[4])};
  return table;
}

struct Coverage {
  int drives = 0, held = 0;
  double sum = 0.0, sum_of_squares = 0.0;  ///< of the errors in standard deviations

  void add(const Interval& found, double truth) {
    const double z = (found.middle - truth) / ((found.high - found.low) / (2.0 * 1.96));
    ++drives;
    held += found.low <= truth && truth <= found.high ? 1 : 0;
    sum += z;
    sum_of_squares += z * z;
  }
};

/// HELIXNAV_CALIBRATION_SEEDS="FIRST LAST" for a study; a few seeds without it.
std::pair<int, int> seeds() {
  int first = 1001, last = 1003;
  if (const char* given = std::getenv("HELIXNAV_CALIBRATION_SEEDS")) std::sscanf(given, "%d %d", &first, &last);
  return {first, last};
}

// The command of the study in docs/your_own_log.md: HELIXNAV_CALIBRATION_SEEDS="1 100" helixnav_test_apps
// --gtest_filter='CalibrationCoverage.*'
TEST(CalibrationCoverage, HoldsTheTruthOfSpoiltLogs) {
  std::map<std::string, Coverage> coverage;
  std::map<std::string, double> worst_noise;
  int drives_tried = 0, broken_off = 0;
  const auto [first, last] = seeds();
  for (int seed = first; seed <= last; ++seed) {
    const testing::TemporaryFolder folder;
    const SpoiltLog log = write_spoilt_log(static_cast<std::uint64_t>(seed), folder.path() / "log");
    const Outcome outcome = run({"calibrate", folder.path() / "log"});
    ++drives_tried;
    if (outcome.exit_code != 0) {
      std::printf("seed %d: exit code %d: %s", seed, outcome.exit_code, outcome.err.c_str());
      ++broken_off;
      continue;
    }
    const auto table = table_of(outcome.out);
    for (const auto& [key, truth] : log.right) {
      if (const auto found = table.find(key); found != table.end()) coverage[key].add(found->second, truth);
    }
    for (const char* kind : {"odometry", "detections"}) {
      coverage[kind].add(table.at(kind), log.noise_scale);
      worst_noise[kind] = std::max(worst_noise[kind], std::abs(table.at(kind).middle / log.noise_scale - 1.0));
    }
  }
  int drives = 0, held = 0;
  for (const auto& [key, of_key] : coverage) {
    std::printf("%-20s %3d of %3d held, mean error %+.2f sigma, root mean square %.2f sigma\n", key.c_str(),
                of_key.held, of_key.drives, of_key.sum / of_key.drives,
                std::sqrt(of_key.sum_of_squares / of_key.drives));
    drives += of_key.drives;
    held += of_key.held;
  }
  std::printf("all: %d of %d; noise off by %.3f (odometry), %.3f (detections) at most\n", held, drives,
              worst_noise["odometry"], worst_noise["detections"]);
  EXPECT_LE(broken_off, drives_tried / 50) << "of " << drives_tried;
  if (drives >= 500) {
    EXPECT_GE(held, 0.90 * drives);
    EXPECT_LE(held, 0.99 * drives);
  }
  EXPECT_GE(coverage.size(), 6u) << "constants are observable in such a log, beside both noises";
  EXPECT_GE(held, 0.85 * drives);  // 95 % of 30: fewer than 26 has a probability of 2 %
  EXPECT_LE(worst_noise["detections"], 0.15);
  EXPECT_LE(worst_noise["odometry"], 0.25);  // 0.207 in 100 drives
}

}  // namespace
}  // namespace helixnav::apps
