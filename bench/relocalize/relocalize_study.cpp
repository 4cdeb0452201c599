// SPDX-License-Identifier: BSD-3-Clause
//
// How often a constellation finds itself in a map without a prior, how often wrongly, and at what cost.
//   helixnav_relocalize_study absent SEED [questions a cell = 2000]    places that are not on the map
//   helixnav_relocalize_study orchards SEED [questions = 2000]         the same in orchards of several pitches and jitters
//   helixnav_relocalize_study present SEED [questions a cell = 600]    places that are on the map, some of them changed
//   helixnav_relocalize_study size SEED [questions a cell = 50]        maps of 10⁴, 10⁵ and 10⁶ landmarks
//   helixnav_relocalize_study priors SEED [questions a cell = 300]       no prior, a true one, a wrong one; two kinds, four; absent
//   helixnav_relocalize_study one SEED WORLD N n CHANGE NOISE CLUTTER JITTER GAPS QUESTIONS present|absent
// Times are processor time of the one calling thread.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "../measures.hpp"
#include "relocalize_worlds.hpp"

namespace {

using namespace helixnav;
using namespace helixnav::relocalize;

struct Cell {
  test::WorldKind kind;
  test::Asking asking;
  bool absent = false;  ///< the question is of another world of the same kind
  int questions = 600;
  int worlds = 1;
  std::optional<double> prior_off_m = std::nullopt;  ///< a prior of 2 m and 3 degrees whose mean is wrong by this much
};

struct Tally {
  int asked = 0, closed = 0, ambiguous = 0, wrong = 0, best_right = 0, capped = 0;
  int pairs = 0, wrong_pairs = 0;
  double seconds = 0.0, longest_s = 0.0, candidates = 0.0, highest_wrong = 0.0;
  std::size_t bytes = 0, landmarks = 0;
  double build_s = 0.0;
};

/// The prior is about the middle of the question: the branch's frame is moved there.
void believe(test::Asked& asked, double off_m) {
  const core::Pose2 T_branch_middle(asked.question.looked.front().centre_m.x(),
                                    asked.question.looked.front().centre_m.y(), 0.0);
  const core::Pose2 T_middle_branch = core::inverse(T_branch_middle);
  for (Landmark& landmark : asked.question.landmarks)
    landmark.point.mean_m = core::transform(T_middle_branch, landmark.point.mean_m);
  asked.question.looked.front().centre_m.setZero();
  asked.T_map_branch = core::compose(asked.T_map_branch, T_branch_middle);
  Prior prior;
  prior.T_map_branch.mean = asked.T_map_branch;
  prior.T_map_branch.mean.x_m += off_m;
  prior.T_map_branch.covariance = Eigen::Vector3d(4.0, 4.0, 0.0025).asDiagonal();
  asked.question.prior = prior;
}

void take(const test::Asked& asked, const Answer& answer, bool absent, Tally& tally) {
  ++tally.asked;
  tally.candidates += answer.candidates;
  tally.capped += answer.capped || answer.crowded;
  tally.ambiguous += answer.verdict == Verdict::ambiguous;
  if (answer.places.empty()) return;
  const Place& best = answer.places.front();
  const bool is_wrong = absent || test::wrong(asked, best.T_map_branch);
  tally.best_right += !is_wrong;
  if (is_wrong) tally.highest_wrong = std::max(tally.highest_wrong, std::min(best.evidence, answer.gap));
  if (answer.verdict != Verdict::closed) return;
  is_wrong ? ++tally.wrong : ++tally.closed;
  if (is_wrong) return;
  for (const Pair& pair : best.pairs) {
    ++tally.pairs;
    tally.wrong_pairs += asked.truth[static_cast<std::size_t>(pair.branch)] != pair.map;
  }
}

Tally run(const Cell& cell, std::uint64_t seed) {
  Tally tally;
  for (int w = 0; w < cell.worlds; ++w) {
    core::RandomStream random(seed, "world " + std::to_string(w));
    core::RandomStream other(seed, "other world " + std::to_string(w));
    const test::Points world = test::world_of(cell.kind, random);
    test::WorldKind smaller = cell.kind;
    smaller.landmarks = std::min<std::size_t>(smaller.landmarks, 20000);
    const test::Points& from = cell.absent ? test::world_of(smaller, other) : world;
    const double begun_s = bench::seconds_of_this_thread();
    const MapIndex index = test::index_of(world, {30.0, cell.asking.noise_m}, cell.asking.kinds);
    tally.build_s += bench::seconds_of_this_thread() - begun_s;
    tally.bytes += index.memory_bytes();
    tally.landmarks += index.size();
    for (int q = w; q < cell.questions; q += cell.worlds) {
      core::RandomStream stream(seed, "question " + std::to_string(q));
      test::Asked asked = test::ask_somewhere(from, cell.asking, stream);
      if (cell.prior_off_m) believe(asked, *cell.prior_off_m);
      const double asked_s = bench::seconds_of_this_thread();
      const Answer answer = ask(index, asked.question);
      const double took_s = bench::seconds_of_this_thread() - asked_s;
      tally.seconds += took_s;
      tally.longest_s = std::max(tally.longest_s, took_s);
      take(asked, answer, cell.absent, tally);
    }
  }
  return tally;
}

void print(const Cell& cell, std::uint64_t seed) {
  const Tally t = run(cell, seed);
  const double asked = std::max(1, t.asked);
  std::printf(
      "%-11s %7zu %3zu %.1f %.2f %.1f %.2f %.2f %.2f %-7s | %5d %.4f %5d %.3f %.3f %5.1f | %d/%d %d | %8.2f %8.1f "
      "%9.0f | %.2f %.0f\n",
      cell.kind.name.c_str(), t.landmarks / static_cast<std::size_t>(cell.worlds), cell.asking.landmarks,
      cell.asking.change, cell.asking.noise_m, cell.asking.clutter, cell.kind.jitter_m, cell.kind.gaps, cell.kind.scale,
      cell.absent ? "absent" : "present", t.asked, t.closed / asked, t.wrong, t.ambiguous / asked, t.best_right / asked,
      t.highest_wrong, t.wrong_pairs, t.pairs, t.capped, 1e3 * t.seconds / asked, 1e3 * t.longest_s,
      t.candidates / asked, t.build_s, static_cast<double>(t.bytes) / static_cast<double>(t.landmarks));
  std::fflush(stdout);
}

void print_heading() {
  std::printf(
      "world             N   n chg noise clut jit gaps scale kind   | asked closed  wrong ambig  best  high  | pairs "
      "wrong/all capped | ms mean      max candidates | build s, B/landmark\n");
}

std::vector<Cell> absent_cells(int questions) {
  std::vector<Cell> cells;
  for (const char* name : {"uniform", "town"})
    for (const std::size_t n : {6U, 10U, 20U}) cells.push_back({{name}, {n}, true, questions, 1});
  for (const std::size_t n : {10U, 20U}) cells.push_back({{"avenues", 10000, 0.3}, {n}, true, questions / 2, 1});
  return cells;
}

std::vector<Cell> orchard_cells(int questions) {
  std::vector<Cell> cells;
  for (const char* name : {"rectangular", "hexagonal"})
    for (const double scale : {0.8, 1.0, 1.4})
      for (const double jitter_m : {0.0, 0.1, 0.3})
        cells.push_back(
            {{name, 400, jitter_m, jitter_m == 0.1 ? 0.0 : 0.05, scale}, {20}, true, questions / 18 + 1, 4});
  return cells;
}

std::vector<Cell> present_cells(int questions) {
  std::vector<Cell> cells;
  for (const char* name : {"uniform", "town"}) {
    for (const double change : {0.0, 0.3, 0.5}) cells.push_back({{name}, {10, change}, false, questions, 1});
    for (const double change : {0.0, 0.3, 0.5}) cells.push_back({{name}, {20, change}, false, questions, 1});
  }
  cells.push_back({{"uniform"}, {20, 0.3, 0.5}, false, questions / 2, 1});
  cells.push_back({{"uniform"}, {20, 0.3, 0.0, 0.3}, false, questions / 4, 1});
  for (const std::size_t n : {10U, 20U}) cells.push_back({{"avenues", 10000, 0.3}, {n, 0.3}, false, questions / 4, 1});
  for (const char* name : {"rectangular", "hexagonal"})
    for (const double jitter_m : {0.0, 0.1, 0.3})
      cells.push_back({{name, 2500, jitter_m, 0.05}, {20}, false, questions / 12, 1});
  return cells;
}

std::vector<Cell> size_cells(int questions) {
  std::vector<Cell> cells;
  for (const std::size_t count : {10000U, 100000U, 1000000U})
    for (const bool absent : {false, true}) cells.push_back({{"uniform", count}, {20, 0.3}, absent, questions, 1});
  for (const std::size_t count : {10000U, 100000U, 1000000U})
    cells.push_back({{"town", count}, {20, 0.3}, false, questions, 1});
  return cells;
}

/// What priors (true, and wrong by 40 m where 2 m are assumed) and kinds add where geometry alone is not enough.
std::vector<Cell> prior_cells(int questions) {
  std::vector<Cell> cells(5, {{"uniform"}, {10, 0.3}, false, questions, 1, {}});
  cells[1].prior_off_m = 0.0;
  cells[2].prior_off_m = 40.0;
  cells[3].asking.kinds = 2;
  cells[4].asking.kinds = 4;
  for (const int kinds : {2, 4}) {
    cells.push_back({{"uniform"}, {10}, true, questions, 1, {}});
    cells.back().asking.kinds = kinds;
  }
  return cells;
}

Cell one_cell(char** argument) {
  Cell cell;
  cell.kind.name = argument[0];
  cell.kind.landmarks = static_cast<std::size_t>(std::atof(argument[1]));
  cell.asking.landmarks = static_cast<std::size_t>(std::atoi(argument[2]));
  cell.asking.change = std::atof(argument[3]);
  cell.asking.noise_m = std::atof(argument[4]);
  cell.asking.clutter = std::atof(argument[5]);
  cell.kind.jitter_m = std::atof(argument[6]);
  cell.kind.gaps = std::atof(argument[7]);
  cell.questions = std::atoi(argument[8]);
  cell.absent = std::string(argument[9]) == "absent";
  return cell;
}

std::vector<Cell> cells_of(int count, char** arguments) {
  const std::string what = count > 2 ? arguments[1] : "";
  const auto questions = [&](int otherwise) { return count > 3 ? std::atoi(arguments[3]) : otherwise; };
  if (what == "absent") return absent_cells(questions(2000));
  if (what == "orchards") return orchard_cells(questions(2000));
  if (what == "present") return present_cells(questions(600));
  if (what == "priors") return prior_cells(questions(300));
  if (what == "size") return size_cells(questions(50));
  if (what == "one" && count == 13) return {one_cell(arguments + 3)};
  throw std::runtime_error("usage: absent|orchards|present|priors|size SEED [QUESTIONS], or one SEED with ten values");
}

}  // namespace

int main(int count, char** arguments) try {
  const std::vector<Cell> cells = cells_of(count, arguments);
  print_heading();
  for (const Cell& cell : cells) print(cell, static_cast<std::uint64_t>(std::atoll(arguments[2])));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "helixnav_relocalize_study: %s\n", error.what());
  return 2;
}
