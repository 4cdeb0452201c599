// SPDX-License-Identifier: BSD-3-Clause
//
// The same questions to this library and to CLIPPER (Lusk, Fathian and How 2021), whose sources the build gets from
// -DHELIXNAV_CLIPPER_DIR=…: https://github.com/mit-acl/clipper.
//   helixnav_relocalize_beside_clipper SEED [questions a cell = 100]
// CLIPPER is given every pair of a landmark and a map's landmark, and finds pairs; the pose is their least-squares fit. It
// decides nothing, so questions that have no place show what a decision by the number of its pairs would be worth.
// Times are processor time of the one calling thread.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <clipper/clipper.h>

#include "../measures.hpp"
#include "helixnav/core/rigid_fit.hpp"
#include "relocalize_worlds.hpp"

namespace {

using namespace helixnav;
using namespace helixnav::relocalize;

struct Cell {
  std::size_t landmarks;
  double change;
  bool absent;
};

/// Distances agree to 3.5 standard deviations of the difference of two; the score's spread is one of them.
struct Peer {
  double spread_m, bound_m;
};

Peer peer_for(double pair_noise_m) {
  const double sigma_m = std::sqrt(2.0) * pair_noise_m;
  return {sigma_m, 3.5 * sigma_m};
}

clipper::invariants::Data columns(const std::vector<Eigen::Vector2d>& points_m) {
  clipper::invariants::Data data(2, static_cast<Eigen::Index>(points_m.size()));
  for (std::size_t i = 0; i < points_m.size(); ++i) data.col(static_cast<Eigen::Index>(i)) = points_m[i];
  return data;
}

struct PeerAnswer {
  int pairs = 0;
  core::Pose2 T_map_branch;
};

PeerAnswer ask_peer(const test::Points& map, const std::vector<Eigen::Vector2d>& branch_m, const Peer& peer) {
  clipper::invariants::EuclideanDistance::Params by_distance;
  by_distance.sigma = peer.spread_m;
  by_distance.epsilon = peer.bound_m;
  clipper::CLIPPER clipper(std::make_shared<clipper::invariants::EuclideanDistance>(by_distance), {});
  clipper.setParallelize(false);
  clipper.scorePairwiseConsistency(columns(map), columns(branch_m));
  clipper.solve();
  const clipper::Association selected = clipper.getSelectedAssociations();
  PeerAnswer answer;
  answer.pairs = static_cast<int>(selected.rows());
  if (answer.pairs < 2) return answer;
  std::vector<Eigen::Vector2d> in_map_m, in_branch_m;
  for (Eigen::Index i = 0; i < selected.rows(); ++i) {
    in_map_m.push_back(map[static_cast<std::size_t>(selected(i, 0))]);
    in_branch_m.push_back(branch_m[static_cast<std::size_t>(selected(i, 1))]);
  }
  answer.T_map_branch = core::fit_rigidly(in_map_m, in_branch_m);
  return answer;
}

struct Tally {
  int closed = 0, wrong = 0, best_right = 0, peer_right = 0, peer_most_pairs_if_wrong = 0;
  std::vector<int> peer_pairs_if_right;
  double ask_s = 0.0, peer_s = 0.0;
};

Tally run(const Cell& cell, int questions, std::uint64_t seed) {
  constexpr double pair_noise_m = 0.1;
  Tally tally;
  for (int q = 0; q < questions; ++q) {
    core::RandomStream random(seed, "clipper " + std::to_string(q));
    const test::Points world = test::uniform_world(cell.landmarks, random);
    const test::Points elsewhere = test::uniform_world(cell.landmarks, random);
    const test::Asked asked =
        test::ask_somewhere(cell.absent ? elsewhere : world, {20, cell.change, 0.0, pair_noise_m, 0}, random);
    const MapIndex index = test::index_of(world, {30.0, pair_noise_m}, 0);
    const double begun_s = bench::seconds_of_this_thread();
    const Answer answer = ask(index, asked.question);
    tally.ask_s += bench::seconds_of_this_thread() - begun_s;
    const bool right = !cell.absent && !answer.places.empty() && !test::wrong(asked, answer.places[0].T_map_branch);
    tally.best_right += right;
    if (answer.verdict == Verdict::closed) ++(right ? tally.closed : tally.wrong);

    std::vector<Eigen::Vector2d> branch_m;
    for (const Landmark& landmark : asked.question.landmarks) branch_m.push_back(landmark.point.mean_m);
    const double peer_begun_s = bench::seconds_of_this_thread();
    const PeerAnswer peer = ask_peer(world, branch_m, peer_for(pair_noise_m));
    tally.peer_s += bench::seconds_of_this_thread() - peer_begun_s;
    if (!cell.absent && peer.pairs >= 2 && !test::wrong(asked, peer.T_map_branch)) {
      ++tally.peer_right;
      tally.peer_pairs_if_right.push_back(peer.pairs);
    } else {
      tally.peer_most_pairs_if_wrong = std::max(tally.peer_most_pairs_if_wrong, peer.pairs);
    }
  }
  return tally;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: %s SEED [questions a cell]\n", arguments[0]);
    return 2;
  }
  const auto seed = static_cast<std::uint64_t>(std::atoll(arguments[1]));
  const int questions = count > 2 ? std::atoi(arguments[2]) : 100;
  std::printf(
      "   N change kind    | closed wrong best right  ms | CLIPPER right, pairs at least, pairs where wrong, ms\n");
  for (const std::size_t landmarks : {100U, 200U, 365U}) {
    for (const Cell& cell : {Cell{landmarks, 0.3, false}, Cell{landmarks, 0.5, false}, Cell{landmarks, 0.3, true}}) {
      const Tally t = run(cell, questions, seed);
      const int least = t.peer_pairs_if_right.empty()
                            ? 0
                            : *std::min_element(t.peer_pairs_if_right.begin(), t.peer_pairs_if_right.end());
      std::printf("%4zu %6.1f %-7s | %6d %5d %10d %6.2f | %6d %4d %4d %8.1f   of %d\n", cell.landmarks, cell.change,
                  cell.absent ? "absent" : "present", t.closed, t.wrong, t.best_right, 1e3 * t.ask_s / questions,
                  t.peer_right, least, t.peer_most_pairs_if_wrong, 1e3 * t.peer_s / questions, questions);
      std::fflush(stdout);
    }
  }
  return 0;
}
