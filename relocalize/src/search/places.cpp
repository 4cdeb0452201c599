// SPDX-License-Identifier: BSD-3-Clause
#include "search/places.hpp"

#include <algorithm>
#include <cmath>

#include "search/pairing.hpp"

namespace helixnav::relocalize {

namespace {

constexpr std::size_t most_polished = 60;
constexpr std::size_t most_shifts = 160;

void sort_by_evidence(std::vector<Hypothesis>& list) {
  std::stable_sort(list.begin(), list.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.evidence > b.evidence; });
}

void drop_unsupported(std::vector<Hypothesis>& list) {
  const auto first =
      std::remove_if(list.begin(), list.end(), [](const Hypothesis& h) { return !std::isfinite(h.evidence); });
  list.erase(first, list.end());
}

/// Are three points of the question near landmarks?
bool supported(const Prepared& asked, const core::Pose2& T) {
  int hits = 0;
  for (std::size_t i = 0; i < asked.points.size() && hits < 3; ++i) {
    const Eigen::Vector2f at = laid(T, asked.points[i]);
    hits += asked.map.grid.occupied(asked.map.nodes, at.x(), at.y(), static_cast<float>(asked.near_m)) ? 1 : 0;
  }
  return hits == 3;
}

/// The pose moved by the way from a paired landmark to each of its neighbours.
std::vector<core::Pose2> shifts(const Prepared& asked, const Hypothesis& best) {
  std::vector<core::Pose2> list;
  const Nodes& nodes = asked.map.nodes;
  for (const Match& match : best.matches) {
    const Node& from = nodes[match.slot];
    const float around_m = 1.2F * std::sqrt(std::min(from.farthest_m2, asked.map.reach_m * asked.map.reach_m));
    std::vector<Neighbour> near;
    asked.map.grid.within(nodes, from.x_m, from.y_m, around_m, [&](Slot slot, float d2_m2) {
      if (d2_m2 >= asked.near_m * asked.near_m) near.push_back({d2_m2, asked.map.details[slot].id, slot});
    });
    std::sort(near.begin(), near.end());
    for (const Neighbour& neighbour : near) {
      core::Pose2 T = best.T_origin_centre;
      T.x_m += nodes[neighbour.slot].x_m - from.x_m;
      T.y_m += nodes[neighbour.slot].y_m - from.y_m;
      const bool known = std::any_of(list.begin(), list.end(), [&](const core::Pose2& other) {
        return (other.position_m() - T.position_m()).norm() < asked.near_m;
      });
      if (!known && supported(asked, T)) list.push_back(T);
      if (list.size() == most_shifts) return list;
    }
  }
  return list;
}

/// One place: about the same pose, or half of the pairs in common (a question that is bent fits its place in two poses).
bool same_place(const Prepared& asked, const Hypothesis& a, const Hypothesis& b) {
  const double apart_m = 1.5 * asked.near_m;
  const double turned_rad = core::wrap_to_pi(a.T_origin_centre.heading_rad - b.T_origin_centre.heading_rad);
  if ((a.T_origin_centre.position_m() - b.T_origin_centre.position_m()).norm() < apart_m &&
      std::abs(turned_rad) < apart_m / std::max(asked.extent_m, apart_m))
    return true;
  std::size_t common = 0;
  for (const Match& match : a.matches)
    common += std::find(b.matches.begin(), b.matches.end(), match) != b.matches.end() ? 1 : 0;
  return 2 * common >= std::min(a.matches.size(), b.matches.size());
}

}  // namespace

std::vector<Hypothesis> find_places(const Prepared& asked, const std::vector<Candidate>& candidates) {
  std::vector<Hypothesis> list;
  for (const Candidate& candidate : candidates) {
    core::Pose2 T = candidate.T_origin_centre;
    refine(asked, {1.2, 0.8}, T);
    list.push_back(weigh(asked, T));
  }
  drop_unsupported(list);
  sort_by_evidence(list);
  if (list.size() > most_polished) list.resize(most_polished);
  for (Hypothesis& h : list) {
    core::Pose2 T = h.T_origin_centre;
    refine(asked, {0.8, 0.0, 0.0}, T);
    h = weigh(asked, T);
  }
  drop_unsupported(list);
  sort_by_evidence(list);
  if (list.empty()) return list;
  for (core::Pose2 T : shifts(asked, list.front())) {
    refine(asked, {1.2, 0.8, 0.0, 0.0}, T);
    list.push_back(weigh(asked, T));
  }
  drop_unsupported(list);
  sort_by_evidence(list);
  std::vector<Hypothesis> places;
  for (const Hypothesis& h : list) {
    const auto same = [&](const Hypothesis& other) { return same_place(asked, h, other); };
    if (std::none_of(places.begin(), places.end(), same)) places.push_back(h);
    if (places.size() == most_places) break;
  }
  return places;
}

}  // namespace helixnav::relocalize
