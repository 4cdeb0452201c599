// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "helixnav/core/decision.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "placing/asked.hpp"
#include "search/old_ground_index.hpp"

namespace helixnav::supervisor {

/// What the whole map has been asked so far, by all searches and outside of any: all share one probability of a false
/// answer.
struct WholeMapQuestions {
  Asked asked;
  std::vector<core::LandmarkId> asked_meanwhile = {};  ///< with which a continuing search asked last, ascending
  double next_path_m = 0.0;  ///< length of the drive when it is asked next whether ground is new
  std::shared_ptr<const OldGroundIndex> old_ground;  ///< null before the first question
  std::int64_t place_again_at = 0;                   ///< from this step on, a place found on another map may be undone
};

/// An answer of the whole map.
struct AskedWholeMap {
  core::WholeMapDecision decision;                      ///< refused where it is closed, until the map is closed there
  std::vector<pf_relocalize::ConstellationPair> pairs;  ///< of the one place that is left; else empty
  /// Of each place that may be the true one where the vehicle is surely on the map; empty if there may be more than were found.
  std::vector<std::vector<pf_relocalize::ConstellationPair>> may_be = {};

  bool is_asked() const { return decision.questions > 0; }
  bool is_closed() const { return !pairs.empty(); }
  /// No place fits better than the best on an unrelated map does by chance in one question of twenty, though with that
  /// many landmarks a place on the map would: with twenty, 0.998 of the places on the map are found if 30 % have
  /// changed (docs/relocalize.md).
  bool is_nowhere() const {
    constexpr int enough = 20;
    static const double by_chance = -std::log(0.05);
    return is_asked() && decision.verdict == core::WholeMapDecision::Verdict::not_here &&
           decision.landmarks >= enough && decision.evidence < by_chance;
  }
  /// At another place than that of these pairs, or at one of several others.
  bool is_elsewhere(const std::vector<pf_relocalize::ConstellationPair>& found) const {
    return !may_be.empty() &&
           std::none_of(may_be.begin(), may_be.end(), [&](const auto& place) { return is_place_of(found, place); });
  }

 private:
  /// Most of the landmarks that have a pair in both have the same.
  static bool is_place_of(const std::vector<pf_relocalize::ConstellationPair>& found,
                          const std::vector<pf_relocalize::ConstellationPair>& place) {
    int same = 0, other = 0;
    for (const pf_relocalize::ConstellationPair& a : found) {
      for (const pf_relocalize::ConstellationPair& b : place) {
        if (a.branch == b.branch) ++(a.old_landmark == b.old_landmark ? same : other);
      }
    }
    return same > other;
  }
};

}  // namespace helixnav::supervisor
