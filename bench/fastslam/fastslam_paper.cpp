// SPDX-License-Identifier: BSD-3-Clause
//
// The experiments of fastslam_nieto2003, figure by figure; docs/fastslam.md has the results.
//   helixnav_fastslam_paper FIGURE [--runs N] [--particles M] [--threads T] [--data FOLDER] [--only METHOD]
#include <cstdlib>
#include <cstring>
#include <functional>
#include <utility>

#include "fastslam_study.hpp"

namespace {

using namespace helixnav::bench;

constexpr const char* usage =
    "usage: helixnav_fastslam_paper FIGURE [--runs N] [--particles M] [--threads T] [--data FOLDER] [--only METHOD]\n"
    "  2-3          two beacons 18 cm apart, both seen in a scan      (simulated, 100 runs)\n"
    "  2-3-single   the same, one of the two seen in a scan           (simulated, 100 runs)\n"
    "  5-7          car park, known association                       (20 seeds)\n"
    "  8-10         Victoria Park, known association, whole log       (5 seeds)\n"
    "  11           car park, unknown association                     (20 seeds)\n"
    "  12           Victoria Park, unknown association, 800 s         (5 seeds)\n"
    "  12-whole     the same, whole log, 100 particles                (5 seeds)\n"
    "  13           four beacons 1 to 1.5 m apart                     (simulated, 30 runs)\n"
    "  14           two robots                                        (simulated, 30 runs)\n"
    "  consistency  NEES and coverage over three laps                 (simulated, 20 runs)\n"
    "  all          every one of these, in this order\n";

int usage_error() {
  std::fputs(usage, stderr);
  return 2;
}

using Figure = std::pair<const char*, std::function<int()>>;

std::vector<Figure> figures(const StudySettings& s, const std::string& only) {
  return {{"2-3", [=] { return run_pair(s, false); }},
          {"2-3-single", [=] { return run_pair(s, true); }},
          {"5-7", [=] { return run_car_park(s, true); }},
          {"8-10", [=] { return run_victoria_park(s, 1e5, "known"); }},
          {"11", [=] { return run_car_park(s, false); }},
          {"12", [=] { return run_victoria_park(s, 800.0, only); }},
          {"12-whole", [=] { return run_victoria_park(s, 1e5, only.empty() ? "FS2 lr" : only); }},
          {"13", [=] { return run_four(s); }},
          {"14", [=] { return run_robots(s, only); }},
          {"consistency", [=] { return run_consistency(s); }}};
}

}  // namespace

int main(int argc, char** argv) {
  StudySettings settings;
  std::string only;
  if (argc < 2 || argc % 2 != 0) return usage_error();
  for (int i = 2; i < argc; i += 2) {
    const std::string key = argv[i];
    if (key == "--data") {
      settings.data = argv[i + 1];
    } else if (key == "--only") {
      only = argv[i + 1];
    } else {
      const long value = std::strtol(argv[i + 1], nullptr, 10);
      if (value < 1 || value > 1'000'000) return usage_error();
      if (key == "--runs") {
        settings.runs = static_cast<int>(value);
      } else if (key == "--particles") {
        settings.particles = static_cast<std::size_t>(value);
      } else if (key == "--threads") {
        settings.threads = static_cast<unsigned>(value);
      } else {
        return usage_error();
      }
    }
  }
  bool known = false;
  for (const Figure& figure : figures(settings, only)) {
    if (std::strcmp(argv[1], "all") != 0 && std::strcmp(argv[1], figure.first) != 0) continue;
    known = true;
    std::printf("== Figure %s\n", figure.first);
    try {
      if (const int status = figure.second(); status != 0) return status;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "helixnav_fastslam_paper: %s\n", error.what());
      return 3;
    }
  }
  return known ? 0 : usage_error();
}
