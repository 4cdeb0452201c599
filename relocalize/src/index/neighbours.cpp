// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "index/parts.hpp"

namespace helixnav::relocalize {

std::vector<Neighbour> MapIndex::Parts::nearest(Slot self, std::size_t wanted) const {
  std::vector<Neighbour> found;
  for (float radius_m = std::min(reach_m, grid.cell_m());; radius_m = std::min(reach_m, 1.7F * radius_m)) {
    found.clear();
    grid.within(nodes, nodes[self].x_m, nodes[self].y_m, radius_m, [&](Slot slot, float d2_m2) {
      if (slot != self) found.push_back({d2_m2, details[slot].id, slot});
    });
    if (found.size() >= wanted || radius_m >= reach_m) break;
  }
  const std::size_t kept = std::min(wanted, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end());
  found.resize(kept);
  return found;
}

void MapIndex::Parts::measure_farthest(Slot slot) {
  Node& node = nodes[slot];
  node.farthest_m2 = 0.0F;
  for (const Slot other : node.near)
    node.farthest_m2 = other == no_slot ? std::numeric_limits<float>::infinity()
                                        : std::max(node.farthest_m2, squared_distance_m2(node, nodes[other]));
}

namespace {

/// The place a new neighbour would take: an empty one, else that of the last in search order; −1 when that is nearer.
int place_for(const Nodes& nodes, const Details& details, Slot slot, const Neighbour& fresh) {
  Neighbour last = {-1.0F, 0, no_slot};
  int place = -1;
  for (int k = 0; k < neighbours; ++k) {
    const Slot other = nodes[slot].near[static_cast<std::size_t>(k)];
    if (other == no_slot) return k;
    const Neighbour here = {squared_distance_m2(nodes[slot], nodes[other]), details[other].id, other};
    if (last < here) {
      last = here;
      place = k;
    }
  }
  return fresh < last ? place : -1;
}

}  // namespace

void MapIndex::Parts::link(Slot slot) {
  std::vector<Exchange> exchanges;
  int place = 0;
  for (const Neighbour& neighbour : nearest(slot, neighbours))
    exchanges.push_back({slot, place++, no_slot, neighbour.slot});
  grid.within(nodes, nodes[slot].x_m, nodes[slot].y_m, reach_m, [&](Slot other, float d2_m2) {
    if (other == slot || d2_m2 > nodes[other].farthest_m2) return;
    const int taken = place_for(nodes, details, other, {d2_m2, details[slot].id, slot});
    if (taken >= 0) exchanges.push_back({other, taken, nodes[other].near[static_cast<std::size_t>(taken)], slot});
  });
  apply(exchanges);
}

void MapIndex::Parts::unlink(Slot slot) {
  std::vector<Exchange> exchanges;
  for (int k = 0; k < neighbours; ++k)
    exchanges.push_back({slot, k, nodes[slot].near[static_cast<std::size_t>(k)], no_slot});
  grid.within(nodes, nodes[slot].x_m, nodes[slot].y_m, reach_m, [&](Slot other, float) {
    const int place = other == slot ? -1 : place_among(nodes, other, slot);
    if (place < 0) return;
    Exchange exchange = {other, place, slot, no_slot};
    for (const Neighbour& n : nearest(other, neighbours + 1))
      if (n.slot != slot && place_among(nodes, other, n.slot) < 0) exchange.after = n.slot;
    exchanges.push_back(exchange);
  });
  apply(exchanges);
}

namespace {

using Triple = std::array<Slot, 3>;

/// Every triangle whose owner may change: of an exchange's landmark with what leaves or enters and another neighbour.
std::vector<Triple> touched(const Nodes& nodes, const std::vector<Exchange>& exchanges) {
  std::vector<Triple> triples;
  const auto add = [&](Slot a, Slot b, Slot c) {
    if (b == no_slot || c == no_slot || b == c) return;
    Triple triple = {a, b, c};
    std::sort(triple.begin(), triple.end());
    triples.push_back(triple);
  };
  for (std::size_t e = 0; e < exchanges.size(); ++e) {
    const Exchange& one = exchanges[e];
    for (const Slot other : nodes[one.of].near) {
      add(one.of, one.before, other);
      add(one.of, one.after, other);
    }
    for (std::size_t f = 0; f < e && exchanges[f].of == one.of; ++f) add(one.of, one.after, exchanges[f].after);
  }
  std::sort(triples.begin(), triples.end());
  triples.erase(std::unique(triples.begin(), triples.end()), triples.end());
  return triples;
}

}  // namespace

void MapIndex::Parts::apply(const std::vector<Exchange>& exchanges) {
  const std::vector<Triple> triples = touched(nodes, exchanges);
  std::vector<std::optional<Stored>> before(triples.size());
  for (std::size_t t = 0; t < triples.size(); ++t) before[t] = stored(nodes, triples[t], least_side_m());
  for (const Exchange& one : exchanges) nodes[one.of].near[static_cast<std::size_t>(one.place)] = one.after;
  for (const Exchange& one : exchanges) measure_farthest(one.of);
  for (std::size_t t = 0; t < triples.size(); ++t) {
    const auto after = stored(nodes, triples[t], least_side_m());
    if (before[t] && after && before[t]->code == after->code) continue;
    if (before[t]) {
      bins.erase(before[t]->sides_m, before[t]->code);
      rarity.count(before[t]->sides_m, -1);
    }
    if (after) {
      bins.insert(after->sides_m, after->code);
      rarity.count(after->sides_m, 1);
    }
  }
}

}  // namespace helixnav::relocalize
