// SPDX-License-Identifier: BSD-3-Clause
//
// Processor time of each association method over many different scans: median, 99th percentile, worst. A scan is timed once, as in
// a run; Google Benchmark repeats one problem and would hide the tail.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "helixnav/association/associate.hpp"
#include "helixnav/association/joint_innovation.hpp"
#include "helixnav/association/k_best.hpp"
#include "measures.hpp"
#include "scenes.hpp"

namespace {

using namespace helixnav;
using association::InnovationProblem;
using association::Method;

double microseconds(const std::function<void()>& work) {
  const double start_s = bench::seconds_of_this_thread();
  work();
  return 1e6 * (bench::seconds_of_this_thread() - start_s);
}

void print(const std::string& what, std::vector<double> times_us) {
  std::sort(times_us.begin(), times_us.end());
  const auto at = [&](double share) { return times_us[static_cast<std::size_t>(share * (times_us.size() - 1))]; };
  std::printf("  %-34s median %9.2f us   p99 %9.2f us   worst %9.2f us\n", what.c_str(), at(0.5), at(0.99), at(1.0));
}

struct Set {
  std::string title;
  std::vector<association::Scene> scenes;
  std::vector<InnovationProblem> problems;
};

/// Problems with the same numbers of observations and landmarks; `sigma` and `patch_m` set how many are in a gate.
Set draw(const std::string& title, int count, int observations, int landmarks, double sigma, double patch_m) {
  core::RandomStream random(2024, title);
  Set set;
  set.title = title;
  for (int t = 0; t < count; ++t) {
    set.scenes.push_back(association::crowded_scene(random, observations, landmarks, sigma, patch_m));
  }
  std::size_t pairs = 0;
  for (const association::Scene& scene : set.scenes) {
    set.problems.push_back(association::make_innovation_problem(scene.map, scene.scan));
    pairs += set.problems.back().pairs.size();
  }
  std::printf("\n%s: %d scans, %d observations, %d candidates, %.2f of them in the gate of an observation\n",
              title.c_str(), count, observations, landmarks,
              static_cast<double>(pairs) / (static_cast<double>(count) * observations));
  return set;
}

void time_each(const std::string& what, const Set& set, const std::function<void(const InnovationProblem&)>& work) {
  std::vector<double> times_us;
  times_us.reserve(set.problems.size());
  for (const InnovationProblem& problem : set.problems) times_us.push_back(microseconds([&] { work(problem); }));
  print(what, times_us);
}

void time_set(const Set& set) {
  std::vector<double> gating_us;
  for (const association::Scene& scene : set.scenes) {
    gating_us.push_back(microseconds([&] { association::make_innovation_problem(scene.map, scene.scan); }));
  }
  print("innovations and gate", gating_us);
  const auto costs = [](const InnovationProblem& problem) {
    return association::likelihood_ratio_costs(problem, 0.9, {});
  };
  std::vector<association::AssignmentProblem> assignments;
  for (const InnovationProblem& problem : set.problems) assignments.push_back(costs(problem));
  std::vector<double> solve_us;
  std::vector<double> k_best_us;
  for (const association::AssignmentProblem& a : assignments) {
    solve_us.push_back(microseconds([&] { association::solve_assignment(a); }));
    k_best_us.push_back(microseconds([&] { association::k_best_assignments(a, 10); }));
  }
  print("optimal assignment alone", solve_us);
  print("10 best assignments", k_best_us);
  for (const Method method :
       {Method::nearest_neighbour, Method::nearest_neighbour_unique, Method::likelihood_ratio, Method::jcbb,
        Method::joint_likelihood_ratio, Method::ihgr_published, Method::ihgr_likelihood_ratio}) {
    std::int64_t most_nodes = 0;
    int hits = 0;
    time_each("associate, " + std::string(association::name(method)), set, [&](const InnovationProblem& problem) {
      const association::Assignment a = association::associate(method, problem);
      most_nodes = std::max(most_nodes, a.nodes);
      hits += a.budget_hit;
    });
    if (most_nodes > 0) {
      std::printf("    at most %lld nodes, budget hit in %d scans\n", static_cast<long long>(most_nodes), hits);
    }
  }
}

/// The dense rectangular problem of the literature: every pair has a cost.
void time_dense_assignment(int rows, int columns, int count) {
  core::RandomStream random(7, "dense");
  std::vector<double> times_us;
  for (int t = 0; t < count; ++t) {
    association::AssignmentProblem problem;
    problem.columns = columns;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        problem.column.push_back(j);
        problem.cost.push_back(random.uniform());
      }
      problem.row_begin.push_back(static_cast<int>(problem.cost.size()));
      problem.unassigned_cost.push_back(0.5);
    }
    times_us.push_back(microseconds([&] { association::solve_assignment(problem); }));
  }
  std::printf("\nevery pair possible: %d random %d x %d problems\n", count, rows, columns);
  print("optimal assignment", times_us);
}

}  // namespace

int main() {
  time_dense_assignment(15, 30, 10'000);
  time_set(draw("usual scan", 10'000, 15, 30, 0.3, 20.0));
  time_set(draw("ambiguous scan", 1'000, 14, 20, 0.3, 8.9));
  time_set(draw("crowded scan", 1'000, 14, 20, 0.3, 6.0));
  time_set(draw("very crowded scan", 200, 14, 30, 0.3, 4.0));
}
