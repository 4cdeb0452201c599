// SPDX-License-Identifier: BSD-3-Clause
// A map frame a hundred kilometres from the drive: what messages say about it when a part has turned.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "atlas_access.hpp"
#include "long_road.hpp"
#include "phase/rigid_fit.hpp"
#include "solve/eliminate.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

/// A kilometre with a fix every 90 m, in a map frame with its origin 224 km away; the fixes pull at it, so it is not met exactly.
Atlas far_away(testing::LongRoad& road) {
  core::PoseGaussian start;
  start.mean = core::Pose2(1e5, 2e5, 0.0);
  start.covariance = Eigen::Vector3d(1.0, 1.0, 0.1).cwiseAbs2().asDiagonal();
  Atlas atlas(start);
  for (int phase = 1; road.steps() < 500; ++phase) {
    const int clone = road.add_phase(atlas);
    if (phase % 5 == 0) road.fix(atlas, clone, start.mean);
    atlas.settle();
  }
  atlas.settle();
  return atlas;
}

/// A node covering a quarter of the drive or more that passes on the map frame and poses.
int part_of(const State& state) {
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const TreeNode& node = state.nodes[i];
    const auto& all = node.shape->variables;
    const bool has_world = std::find(all.begin() + node.shape->eliminated, all.end(), state.world) != all.end();
    if (static_cast<int>(i) != state.root && node.leaves >= static_cast<int>(state.phases.size()) / 4 && has_world)
      return static_cast<int>(i);
  }
  return -1;
}

struct Carried {
  double chi2;
  Eigen::VectorXd pull;
};

/// The message of a node at the present values.
Carried carried(const State& state, int id) {
  const FrontShape& shape = *state.node(id).shape;
  std::vector<int> offsets;
  for (std::size_t k = State::index(shape.eliminated); k < shape.variables.size(); ++k) {
    offsets.push_back(shape.offsets[k] - shape.ne);
  }
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(shape.nb + 1, shape.nb + 1);
  add_message(state, id, motion_of_boundary(state, id), offsets,
              Eigen::Map<Eigen::MatrixXd>(F.data(), F.rows(), F.cols()));
  return {F(shape.nb, shape.nb), F.row(shape.nb).head(shape.nb).transpose()};
}

/// Turns all variables of a node except the map frame about one of them.
void turn_part(State& state, int id, double turn_rad) {
  const FrontShape& shape = *state.node(id).shape;
  const Eigen::Matrix2d R = core::rotation(turn_rad);
  const Eigen::Vector2d about_m = state.value(shape.variables.back()).head<2>();
  for (std::size_t k = 0; k < shape.variables.size(); ++k) {
    if (shape.variables[k] == state.world) continue;
    Eigen::Vector3d& value = state.values.write(State::index(shape.variables[k]));
    value.head<2>() = about_m + R * (value.head<2>() - about_m);
    if (state.variable(shape.variables[k]).dim == 3) value.z() += turn_rad;
  }
}

TEST(FarFrame, TheMessagesRightHandSideIsTheGradientOfItsChi2) {
  testing::LongRoad road(3);
  Atlas atlas = far_away(road);
  State state = AtlasAccess::working(atlas);
  const int part = part_of(state);
  ASSERT_GE(part, 0);
  turn_part(state, part, 1e-3);
  const Carried here = carried(state, part);
  const FrontShape& shape = *state.node(part).shape;
  for (std::size_t k = State::index(shape.eliminated); k < shape.variables.size(); ++k) {
    const int v = shape.variables[k];
    for (int axis = 0; axis < state.variable(v).dim; ++axis) {
      const double step = axis == 2 ? (v == state.world ? 1e-7 : 1e-5) : 1e-3;
      State moved = state;
      moved.values.write(State::index(v))[axis] += step;
      const double ahead = carried(moved, part).chi2;
      moved.values.write(State::index(v))[axis] -= 2.0 * step;
      const double difference = (ahead - carried(moved, part).chi2) / (2.0 * step);
      const double gradient = -2.0 * here.pull[shape.offsets[k] - shape.ne + axis];
      EXPECT_NEAR(gradient, difference, 1e-3 * (std::abs(gradient) + 100.0)) << "variable " << v << ", axis " << axis;
    }
  }
}

TEST(FarFrame, APartThatTurnedPullsAsIfItWereLinearisedThere) {
  testing::LongRoad road(3);
  Atlas atlas = far_away(road);
  State state = AtlasAccess::working(atlas);
  int with_fixes = 0;
  for (int phase = 0; phase < static_cast<int>(state.phases.size()); ++phase) {
    const int leaf = state.leaf_of_phase[State::index(phase)];
    if (state.leaf(phase).parts.size() < 2) continue;
    ++with_fixes;
    State turned = state;
    Workspace workspace;
    eliminate(turned, leaf, workspace);  // so that nothing but the turn has moved it
    turn_part(turned, leaf, 1e-3);
    const Eigen::VectorXd pull = carried(turned, leaf).pull;
    eliminate(turned, leaf, workspace);
    const FrontShape& shape = *state.node(leaf).shape;
    for (std::size_t k = State::index(shape.eliminated); k < shape.variables.size(); ++k) {
      if (shape.variables[k] == state.world) continue;
      const Index row = shape.offsets[k] - shape.ne;
      const Eigen::Vector2d off = pull.segment<2>(row) - carried(turned, leaf).pull.segment<2>(row);
      EXPECT_LT(off.norm(), 0.02) << "phase " << phase << ", variable " << shape.variables[k];
    }
  }
  EXPECT_GT(with_fixes, 5);
}

}  // namespace
}  // namespace helixnav::atlas
