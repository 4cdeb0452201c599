// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/relocalize/elsewhere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "helixnav/relocalize/repetition.hpp"
#include "index/parts.hpp"

namespace helixnav::relocalize {

namespace {

constexpr std::size_t most_constellations = 32;
constexpr double stands_twice = 0.5;  ///< of a constellation's evidence for its own place

/// Those in use, by id, so that their order is not that of the calls which made the index.
std::vector<Slot> slots_of(const MapIndex::Parts& parts) {
  std::vector<Slot> slots;
  for (std::size_t k = 0; k < parts.nodes.size(); ++k) {
    const auto slot = static_cast<Slot>(k);
    if (parts.slot_of(parts.details[slot].id) == slot) slots.push_back(slot);
  }
  std::sort(slots.begin(), slots.end(), [&](Slot a, Slot b) { return parts.details[a].id < parts.details[b].id; });
  return slots;
}

Landmark landmark_at(const MapIndex::Parts& parts, Slot slot) {
  const Node& node = parts.nodes[slot];
  const Detail& detail = parts.details[slot];
  Landmark landmark;
  landmark.id = detail.id;
  landmark.point.mean_m = parts.origin_m + Eigen::Vector2d(node.x_m, node.y_m);
  landmark.point.covariance_m2 << detail.xx_m2, detail.xy_m2, detail.xy_m2, detail.yy_m2;
  constexpr double rounding = 1e-6;  // it is kept in single precision, and may not be positive definite any more
  landmark.point.covariance_m2.diagonal().array() += rounding * landmark.point.covariance_m2.trace();
  const Trait& trait = parts.traits[slot];
  landmark.kind = trait.kind;
  if (trait.size_sigma_m >= 0.0F) landmark.size = Size{trait.size_m, trait.size_sigma_m};
  return landmark;
}

/// The landmarks nearest to one of them, itself first.
Question constellation_about(const MapIndex::Parts& parts, const std::vector<Slot>& slots, Slot centre,
                             std::size_t landmarks) {
  std::vector<std::pair<float, Slot>> near;
  for (const Slot slot : slots) near.emplace_back(squared_distance_m2(parts.nodes[slot], parts.nodes[centre]), slot);
  const auto wanted = static_cast<std::ptrdiff_t>(std::min(landmarks, near.size()));
  std::partial_sort(near.begin(), near.begin() + wanted, near.end());
  near.resize(static_cast<std::size_t>(wanted));
  Question question;
  std::vector<Eigen::Vector2d> points_m;
  for (const auto& [d2_m2, slot] : near) {
    question.landmarks.push_back(landmark_at(parts, slot));
    points_m.push_back(question.landmarks.back().point.mean_m);
  }
  question.looked = ground_around(points_m, parts.options.reach_m);
  return question;
}

bool is_where_it_is(const Place& place) {
  const auto itself = [](const Pair& pair) { return pair.branch == pair.map; };
  return 2 * std::count_if(place.pairs.begin(), place.pairs.end(), itself) >=
         static_cast<std::ptrdiff_t>(place.pairs.size());
}

/// Of one constellation; −∞ if it fits nowhere else, or stands twice.
double best_elsewhere(const std::vector<Place>& places) {
  const auto here = std::find_if(places.begin(), places.end(), is_where_it_is);
  const auto there = std::find_if_not(places.begin(), places.end(), is_where_it_is);
  constexpr double none = -std::numeric_limits<double>::infinity();
  if (here == places.end() || there == places.end()) return none;
  return there->evidence < stands_twice * here->evidence ? there->evidence : none;
}

}  // namespace

double evidence_elsewhere(const MapIndex& map, std::size_t landmarks, double enough) {
  const std::vector<Slot> slots = slots_of(map.parts());
  const std::size_t constellations = std::min(most_constellations, slots.size());
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < constellations && best < enough; ++k) {
    const Slot centre = slots[k * slots.size() / constellations];
    const Question question = constellation_about(map.parts(), slots, centre, landmarks);
    if (!question.looked.empty()) best = std::max(best, best_elsewhere(ask(map, question).places));
  }
  return best;
}

void judge_where_places_repeat(const MapIndex& map, const Question& question, const AskOptions& options,
                               Answer& answer) {
  if (answer.verdict != Verdict::closed) return;
  const Place& best = answer.places.front();
  const double lead_needed = -std::log(options.alpha);
  const double share = independent_share(map, question, best);
  answer.gap *= share;
  const bool is_open = answer.gap < lead_needed || share * best.evidence < evidence_needed(options);
  if (!is_open) {
    const double elsewhere = evidence_elsewhere(map, question.landmarks.size(), best.evidence - lead_needed);
    answer.gap = std::min(answer.gap, best.evidence - std::max(0.0, elsewhere));
  }
  if (is_open || answer.gap < lead_needed) answer.verdict = Verdict::ambiguous;
}

Answer ask_where_places_repeat(const MapIndex& map, const Question& question, const AskOptions& options) {
  Answer answer = ask(map, question, options);
  judge_where_places_repeat(map, question, options, answer);
  return answer;
}

}  // namespace helixnav::relocalize
