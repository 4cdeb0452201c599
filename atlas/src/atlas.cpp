// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/atlas/atlas.hpp"

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {
namespace {

int add_pose(State& state, const core::Pose2& T_atlas_pose, int name) {
  Variable variable;
  variable.dim = 3;
  variable.name = name;
  state.variables.push_back(variable);
  state.values.push_back(T_atlas_pose.vector());
  state.phases_of.push_back(std::make_shared<const std::vector<int>>());
  return static_cast<int>(state.variables.size()) - 1;
}

}  // namespace

Atlas::Atlas(const core::PoseGaussian& start, const Options& options)
    : working_(std::make_unique<State>()), settled_(std::make_unique<State>()) {
  const bool is_certain = start.covariance.isZero(0.0);
  if (!start.mean.vector().allFinite() || (!is_certain && !core::is_symmetric_positive_definite(start.covariance))) {
    throw core::PreconditionError("atlas: covariance of the start is neither zero nor symmetric positive definite");
  }
  State& state = *working_;
  state.options = options;
  state.start = start;
  if (is_certain) {
    state.world = add_pose(state, start.mean, 0);
    state.variable_of_clone.push_back(state.world);
  } else {
    state.world = add_pose(state, core::Pose2(), -1);
    state.variable_of_clone.push_back(add_pose(state, start.mean, 0));
  }
  *settled_ = state;
}

Atlas::Atlas(const Atlas& other)
    : working_(std::make_unique<State>(*other.working_)), settled_(std::make_unique<State>(*other.settled_)) {}

Atlas& Atlas::operator=(const Atlas& other) {
  if (this == &other) return *this;
  *working_ = *other.working_;
  *settled_ = *other.settled_;
  nodes_redone_ = 0;
  return *this;
}

Atlas::Atlas(Atlas&& other) noexcept = default;
Atlas& Atlas::operator=(Atlas&& other) noexcept = default;
Atlas::~Atlas() = default;

}  // namespace helixnav::atlas
