// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of robots of an MRCLAM run from unknown starts: where the second robot is, seen from the first, once one kind of
// evidence has joined them, against the truth of the run. The table of docs/team.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "helixnav/team/team.hpp"

namespace helixnav::bench {
namespace {

using By = team::TeamJoin::By;

constexpr double wrong_m = 1.5;
constexpr double wrong_rad = 20.0 * core::pi / 180.0;

/// By what evidence, and whether a robot knows its own landmarks by their barcodes.
struct Way {
  By by;
  bool has_names = true;
};

struct Joined {
  double t_s = 0.0, error_m = 0.0, error_rad = 0.0;
  team::TeamJoin join;
};

/// An event (i ≥ 0), or a sighting of a robot (−1 − its index), in the order in which Team expects them.
struct Fed {
  core::Nanoseconds t_ns;
  int kind;
  std::size_t robot;
  std::ptrdiff_t index;
  std::size_t scan;
};

std::vector<Fed> in_order(const core::TeamRecording& recording) {
  std::vector<Fed> all;
  for (std::size_t r = 0; r < recording.robots.size(); ++r) {
    const core::TeamMember& member = recording.robots[r];
    std::size_t scan = 0;
    for (std::size_t i = 0; i < member.recording.events.size(); ++i) {
      const core::Event& event = member.recording.events[i];
      const bool is_scan = std::holds_alternative<core::Scan>(event);
      all.push_back({core::time_of(event), is_scan ? 2 : 0, r, static_cast<std::ptrdiff_t>(i), is_scan ? scan++ : 0});
    }
    for (std::size_t i = 0; i < member.sightings.size(); ++i) {
      all.push_back({member.sightings[i].t_ns, 1, r, -1 - static_cast<std::ptrdiff_t>(i), 0});
    }
  }
  const auto key = [](const Fed& fed) { return std::make_tuple(fed.t_ns, fed.kind, fed.robot); };
  std::stable_sort(all.begin(), all.end(), [&](const Fed& a, const Fed& b) { return key(a) < key(b); });
  return all;
}

void give(const core::TeamRecording& recording, const Fed& fed, const Way& way, team::Team& team) {
  const core::TeamMember& member = recording.robots[fed.robot];
  const int robot = static_cast<int>(fed.robot);
  if (fed.kind == 1) {
    team.sight(robot, member.sightings[static_cast<std::size_t>(-1 - fed.index)]);
    return;
  }
  std::vector<std::int64_t> names;
  if (fed.kind == 2 && way.has_names) names = member.recording.labels[fed.scan];
  for (std::int64_t& name : names) name += way.by == By::names || name < 0 ? 0 : 1000 * (robot + 1);
  team.take(robot, member.recording.events[static_cast<std::size_t>(fed.index)], names);
}

/// The true pose nearest in time: those of Vicon come every 10 ms.
core::Pose2 truth_at(const std::vector<core::TruePose>& truth, core::Nanoseconds t_ns) {
  const auto after = std::lower_bound(truth.begin(), truth.end(), t_ns,
                                      [](const core::TruePose& pose, core::Nanoseconds t) { return pose.t_ns < t; });
  return (after == truth.end() ? std::prev(after) : after)->T_world_robot;
}

std::optional<Joined> drive(const core::TeamRecording& recording, const Way& way) {
  const By by = way.by;
  team::TeamOptions options;
  options.looks_as_one = recording.looks_as_one;
  options.join.by_place = !way.has_names;
  options.join.by_names = by == By::names;
  options.join.by_sightings = by == By::sightings;
  options.join.by_constellation = by == By::constellation;
  team::Team team(std::vector<std::optional<core::PoseGaussian>>(2), options);
  std::vector<core::Nanoseconds> moved_ns(2, 0);
  for (const Fed& fed : in_order(recording)) {
    if (fed.kind == 0) moved_ns[fed.robot] = fed.t_ns;
    give(recording, fed, way, team);
    if (team.joins().empty()) continue;
    const core::Pose2 truth = core::between(truth_at(recording.robots[0].recording.true_poses, moved_ns[0]),
                                            truth_at(recording.robots[1].recording.true_poses, moved_ns[1]));
    const core::Pose2 estimate = core::between(team.pose(0).mean, team.pose(1).mean);
    return Joined{core::seconds(fed.t_ns), (estimate.position_m() - truth.position_m()).norm(),
                  std::abs(core::wrap_to_pi(estimate.heading_rad - truth.heading_rad)), team.joins().front()};
  }
  return std::nullopt;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

void print_total(const Way& way, int pairs, const std::vector<Joined>& joined) {
  std::vector<double> errors_m, errors_deg;
  int wrong = 0;
  for (const Joined& one : joined) {
    errors_m.push_back(one.error_m);
    errors_deg.push_back(one.error_rad * 180.0 / core::pi);
    wrong += one.error_m > wrong_m || one.error_rad > wrong_rad ? 1 : 0;
  }
  std::printf("%-14s%s joined %zu of %d, wrong (beyond 1.5 m or 20 deg) %d", name_of(way.by),
              way.has_names ? "" : " without any name", joined.size(), pairs, wrong);
  if (!joined.empty()) {
    std::printf("; position median %.3f, max %.3f m; heading median %.1f, max %.1f deg", median(errors_m),
                *std::max_element(errors_m.begin(), errors_m.end()), median(errors_deg),
                *std::max_element(errors_deg.begin(), errors_deg.end()));
  }
  std::printf("\n");
}

int run(const std::string& path) {
  constexpr int robots = 5;
  for (const Way& way : {Way{By::sightings}, Way{By::names}, Way{By::constellation}, Way{By::constellation, false}}) {
    std::vector<Joined> all;
    int pairs = 0;
    for (int a = 1; a <= robots; ++a) {
      for (int b = a + 1; b <= robots; ++b, ++pairs) {
        const core::TeamRecording recording = logs::read_mrclam(path, {a, b});
        if (!recording.starts_known) throw core::InputError(path + ": robots have no truth");
        const std::optional<Joined> joined = drive(recording, way);
        if (joined) {
          std::printf("  %d %d  at %5.1f s  %.3f m  %.1f deg, %d landmarks, chi2 %.1f of at most %.1f\n", a, b,
                      joined->t_s, joined->error_m, joined->error_rad * 180.0 / core::pi, joined->join.merged,
                      joined->join.cost, joined->join.limit);
          all.push_back(*joined);
        } else {
          std::printf("  %d %d  not joined\n", a, b);
        }
      }
    }
    print_total(way, pairs, all);
  }
  return 0;
}

}  // namespace
}  // namespace helixnav::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: helixnav_team_pairs MRCLAM_RUN\n");
    return 2;
  }
  try {
    return helixnav::bench::run(argv[1]);
  } catch (const helixnav::core::InputError& error) {
    std::fprintf(stderr, "helixnav_team_pairs: %s\n", error.what());
    return 3;
  }
}
