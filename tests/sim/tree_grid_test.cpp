// SPDX-License-Identifier: BSD-3-Clause
#include "tree_grid.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::sim {
namespace {

std::vector<Tree> scattered_trees(core::RandomStream& random) {
  std::vector<Tree> trees(500);
  for (Tree& tree : trees) tree.point_m = {random.uniform(-200.0, 200.0), random.uniform(-150.0, 250.0)};
  return trees;
}

TEST(TreeGrid, FindsEveryTreeWithinTheRadiusOnceAndFewBeyond) {
  core::RandomStream random(11, "tree_grid_test");
  const std::vector<Tree> trees = scattered_trees(random);
  const TreeGrid grid(trees, 30.0);
  std::size_t looked_at = 0;
  constexpr int places = 200;
  for (int k = 0; k < places; ++k) {
    const Eigen::Vector2d point_m(random.uniform(-250.0, 250.0), random.uniform(-250.0, 250.0));
    std::vector<std::size_t> found = grid.about(point_m, 30.0);
    looked_at += found.size();
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (std::size_t i = 0; i < trees.size(); ++i) {
      const bool is_near = (trees[i].point_m - point_m).norm() <= 30.0;
      if (is_near) {
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << "tree " << i;
      }
    }
  }
  EXPECT_LT(looked_at, trees.size() * places / 10);
}

TEST(TreeGrid, OfNoTreesFindsNone) { EXPECT_TRUE(TreeGrid({}, 10.0).about({3.0, 4.0}, 100.0).empty()); }

}  // namespace
}  // namespace helixnav::sim
