// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/atlas/atlas.hpp"

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {
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
    state.world = add_variable(state, 3, 0, start.mean.vector());
    state.variable_of_clone.push_back(state.world);
  } else {
    state.world = add_variable(state, 3, -1, Eigen::Vector3d::Zero());
    state.variable_of_clone.push_back(add_variable(state, 3, 0, start.mean.vector()));
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
