// SPDX-License-Identifier: BSD-3-Clause
//
// Processor time of the association methods on problems drawn from runs: each scan of a drive is timed once, as in a run,
// while the likelihood-ratio assignment continues mapping.
//   helixnav_association_times            15 observations of 30 landmarks, more than 10 000 scans: median, p99, worst
//   helixnav_association_times --figure3  time against the number of features, all seen at once (ihgr_zhang2005 Fig. 3),
//                                         as CSV
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "helixnav/association/k_best.hpp"
#include "helixnav/sim/ihgr_circle.hpp"
#include "mapping_loop.hpp"

namespace {

using namespace helixnav;
using association::InnovationProblem;
using association::Method;

struct Times {
  std::string name;
  std::function<association::Assignment(const InnovationProblem&)> solve;
  std::vector<double> us;
  int budget_hits = 0;

  void run(const InnovationProblem& problem) {
    const double begin_s = bench::seconds_of_this_thread();
    const association::Assignment assignment = solve(problem);
    us.push_back(1e6 * (bench::seconds_of_this_thread() - begin_s));
    budget_hits += assignment.budget_hit;
  }
  double quantile(double share) const {
    std::vector<double> sorted = us;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
};

/// The methods alone, without the joint test of all pairs, which is the same for all.
std::vector<Times> methods() {
  std::vector<Times> list;
  for (const Method method :
       {Method::nearest_neighbour, Method::nearest_neighbour_unique, Method::ihgr_published,
        Method::ihgr_likelihood_ratio, Method::likelihood_ratio, Method::jcbb, Method::joint_likelihood_ratio}) {
    association::Options options;
    options.joint_test = false;
    const auto solve = [=](const InnovationProblem& p) { return association::associate(method, p, options); };
    list.push_back({std::string(association::name(method)), solve, {}, 0});
  }
  const auto optimum = [](const InnovationProblem& problem) {
    association::solve_assignment(association::likelihood_ratio_costs(problem, 0.9, {}));
    return association::Assignment{};
  };
  list.push_back({"optimal assignment alone", optimum, {}, 0});
  return list;
}

/// Drives layouts of the world and times every `every`-th scan for which `wanted` holds.
void time_runs(const sim::IhgrCircle& world, int layouts, int every,
               const std::function<bool(const InnovationProblem&)>& wanted, std::vector<Times>& list) {
  int scan = 0;
  const auto time_all = [&](const InnovationProblem& problem) {
    if (!wanted(problem) || ++scan % every != 0) return;
    for (Times& times : list) times.run(problem);
  };
  bench::MappingOptions mapping;
  mapping.filter.cell_side_m = 1000.0;
  mapping.filter.max_active_landmarks = 1000;
  for (int layout = 1; layout <= layouts; ++layout) {
    const core::Recording recording = sim::simulate_ihgr_circle(world, static_cast<std::uint64_t>(layout));
    bench::map_along(recording.start, recording.events, mapping, time_all);
  }
}

void print_usual_scans() {
  sim::IhgrCircle world;
  world.features = 30;
  std::vector<Times> list = methods();
  double observations = 0.0;
  double candidates = 0.0;
  double pairs = 0.0;
  const auto wanted = [&](const InnovationProblem& p) {
    if (p.observations.size() < 12 || p.observations.size() > 18 || p.ids.size() < 25) return false;
    observations += static_cast<double>(p.observations.size());
    candidates += static_cast<double>(p.ids.size());
    pairs += static_cast<double>(p.pairs.size());
    return true;
  };
  time_runs(world, 80, 1, wanted, list);
  const auto count = static_cast<double>(list.front().us.size());
  std::printf("%.0f scans drawn from 80 runs: %.1f observations, %.1f candidates, %.2f of them in a gate\n", count,
              observations / count, candidates / count, pairs / observations);
  for (const Times& times : list) {
    std::printf("  %-28s median %8.2f us   p99 %8.2f us   worst %9.2f us   budget hit %d\n", times.name.c_str(),
                times.quantile(0.5), times.quantile(0.99), times.quantile(1.0), times.budget_hits);
  }
}

void print_figure_3() {
  std::printf("features,method,scans,mean_us,median_us,p99_us,worst_us,budget_hits\n");
  for (const int features : {5, 10, 15, 20, 30, 40, 60}) {
    sim::IhgrCircle world;
    world.features = features;
    world.field_of_view.min_bearing_rad = -core::pi;
    world.field_of_view.max_bearing_rad = core::pi;
    std::vector<Times> list = methods();
    time_runs(
        world, 4, 4, [](const InnovationProblem& p) { return !p.ids.empty(); }, list);
    for (const Times& times : list) {
      const double mean_us = std::accumulate(times.us.begin(), times.us.end(), 0.0) / times.us.size();
      std::printf("%d,%s,%zu,%.2f,%.2f,%.2f,%.2f,%d\n", features, times.name.c_str(), times.us.size(), mean_us,
                  times.quantile(0.5), times.quantile(0.99), times.quantile(1.0), times.budget_hits);
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--figure3") == 0) {
    print_figure_3();
  } else if (argc == 1) {
    print_usual_scans();
  } else {
    std::fprintf(stderr, "usage: %s [--figure3]\n", argv[0]);
    return 2;
  }
}
