// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "question/prepared.hpp"

namespace helixnav::relocalize {

/// A triangle of the question, corners in the order of its sides.
struct QuestionTriangle {
  int stratum = 0;  ///< 0: of the nearest neighbours, which the map most likely holds
  std::uint32_t rarity = 0;
  std::array<int, 3> corners{};
  Sides sides_m{};
};

/// The triangles to look up, in order: near neighbours first, the rarest of these first, and no landmark more often
/// than its share, so that one spurious landmark does not spoil them all. Nearly equal sides are looked up in each
/// order they may have in the map.
std::vector<QuestionTriangle> question_triangles(const Prepared& asked, std::size_t most);

}  // namespace helixnav::relocalize
