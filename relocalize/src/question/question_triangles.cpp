// SPDX-License-Identifier: BSD-3-Clause
#include "question/question_triangles.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace helixnav::relocalize {

namespace {

/// The map's eight, and four for landmarks that the map does not have.
constexpr std::size_t question_neighbours = neighbours + 4;

float squared(const Point& a, const Point& b) {
  const float dx = a.x_m - b.x_m;
  const float dy = a.y_m - b.y_m;
  return dx * dx + dy * dy;
}

std::vector<int> nearest(const std::vector<Point>& points, std::size_t self) {
  std::vector<std::pair<float, int>> order;
  for (std::size_t j = 0; j < points.size(); ++j)
    if (j != self) order.emplace_back(squared(points[self], points[j]), static_cast<int>(j));
  const std::size_t kept = std::min(order.size(), question_neighbours);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end());
  std::vector<int> list;
  for (std::size_t k = 0; k < kept; ++k) list.push_back(order[k].second);
  return list;
}

/// Appends the triangle in each order whose first side is the longest up to noise.
void append_turns(const Prepared& asked, const std::array<int, 3>& corners, int stratum,
                  std::vector<QuestionTriangle>& list) {
  const auto point = [&](int k) {
    return asked.points[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
  };
  const auto shape = canonical(point(0), point(1), point(2), asked.map.least_side_m());
  if (!shape) return;
  const float tolerance_m = asked.map.side_tolerance_m();
  for (std::size_t start = 0; start < 3; ++start) {
    if (shape->sides_m[start] <= shape->sides_m[0] - 2.0F * tolerance_m) continue;
    QuestionTriangle triangle;
    triangle.stratum = stratum;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.sides_m[k] = shape->sides_m[(start + k) % 3];
      triangle.corners[k] = corners[static_cast<std::size_t>(shape->order[(start + k) % 3])];
    }
    triangle.rarity = asked.map.rarity.of(triangle.sides_m);
    list.push_back(triangle);
  }
}

std::vector<QuestionTriangle> all_triangles(const Prepared& asked) {
  std::vector<QuestionTriangle> list;
  std::set<std::array<int, 3>> known;
  // By the rank of the farther neighbour, so that a triangle counts where it is nearest.
  std::vector<std::vector<int>> near;
  for (std::size_t i = 0; i < asked.points.size(); ++i) near.push_back(nearest(asked.points, i));
  for (std::size_t rank = 1; rank < question_neighbours; ++rank)
    for (std::size_t i = 0; i < near.size(); ++i)
      for (std::size_t other = 0; other < rank && rank < near[i].size(); ++other) {
        std::array<int, 3> corners = {static_cast<int>(i), near[i][other], near[i][rank]};
        std::sort(corners.begin(), corners.end());
        if (!known.insert(corners).second) continue;
        append_turns(asked, corners, std::max(0, static_cast<int>(rank) - 3) / 2, list);
      }
  std::sort(list.begin(), list.end(), [](const QuestionTriangle& a, const QuestionTriangle& b) {
    return std::tie(a.stratum, a.rarity, a.corners) < std::tie(b.stratum, b.rarity, b.corners);
  });
  return list;
}

}  // namespace

std::vector<QuestionTriangle> question_triangles(const Prepared& asked, std::size_t most) {
  const std::size_t share = std::max<std::size_t>(4, 6 * most / asked.points.size());
  std::vector<std::size_t> used(asked.points.size(), 0);
  const auto use = [&](int corner) -> std::size_t& { return used[static_cast<std::size_t>(corner)]; };
  std::vector<QuestionTriangle> chosen;
  for (const QuestionTriangle& triangle : all_triangles(asked)) {
    const auto& [a, b, c] = triangle.corners;
    if (std::min({use(a), use(b), use(c)}) >= share) continue;
    for (const int corner : triangle.corners) ++use(corner);
    chosen.push_back(triangle);
    if (chosen.size() == most) break;
  }
  return chosen;
}

}  // namespace helixnav::relocalize
