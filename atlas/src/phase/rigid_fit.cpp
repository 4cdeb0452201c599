// SPDX-License-Identifier: BSD-3-Clause
#include "phase/rigid_fit.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/angle.hpp"

namespace helixnav::atlas {
namespace {

constexpr double smallest_span_m = 10.0;

RigidMotion fit(const State& state, const int* variables, const Eigen::Vector3d* was, const Values& now) {
  const std::size_t n = now.size();
  const auto takes_part = [&](std::size_t i) { return n == 1 || variables[i] != state.world; };
  RigidMotion motion;
  motion.is_identity = false;
  double count = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!takes_part(i)) continue;
    motion.from_m += was[i].head<2>();
    motion.to_m += now[i].head<2>();
    count += 1.0;
  }
  motion.from_m /= count;
  motion.to_m /= count;
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!takes_part(i)) continue;
    const Eigen::Vector2d p = was[i].head<2>() - motion.from_m;
    const Eigen::Vector2d q = now[i].head<2>() - motion.to_m;
    along += p.dot(q);
    across += p.x() * q.y() - p.y() * q.x();
    if (state.variable(variables[i]).dim == 3) {
      along += std::cos(now[i].z() - was[i].z());
      across += std::sin(now[i].z() - was[i].z());
    }
  }
  motion.turn_rad = std::atan2(across, along);
  motion.R = core::rotation(motion.turn_rad);
  return motion;
}

bool is_far_frame(const State& state, int variable, std::size_t count) { return variable == state.world && count > 1; }

/// Replaces the chord of the map frame's position in motion.rest by what has moved at the centre of the part.
void rest_of_far_frame(const Eigen::Vector2d& was_m, Eigen::Index row, Motion& motion) {
  const Eigen::Vector2d to_center_m = motion.rigid.from_m - was_m;
  const double turn_rad = motion.rest[row + 2];
  const Eigen::Vector2d turned_m = core::rotation(turn_rad) * to_center_m - to_center_m;
  motion.world.row = row;
  motion.world.off_m = motion.rest.segment<2>(row) + turned_m;
  motion.world.lever_m << -turned_m.y(), turned_m.x();
  motion.rest.segment<2>(row) = motion.world.off_m - turn_rad * Eigen::Vector2d(-to_center_m.y(), to_center_m.x());
}

}  // namespace

Eigen::Vector2d RigidMotion::point(const Eigen::Vector2d& p) const {
  if (is_identity) return p;
  return to_m + R * (p - from_m);
}

Eigen::Vector3d RigidMotion::operator()(const Eigen::Vector3d& value, int dim) const {
  if (is_identity) return value;
  Eigen::Vector3d moved;
  moved.head<2>() = point(value.head<2>());
  moved[2] = dim == 3 ? core::wrap_to_pi(value.z() + turn_rad) : 0.0;
  return moved;
}

Motion motion_of(const State& state, const FrontShape& shape, int begin, const Eigen::Vector3d* was,
                 const Values& now) {
  Motion motion;
  if (std::equal(now.begin(), now.end(), was)) return motion;
  const int* variables = shape.variables.data() + begin;
  motion.rigid = fit(state, variables, was, now);
  double span_m = smallest_span_m;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (is_far_frame(state, variables[i], now.size())) continue;
    const double arm_m = (was[i].head<2>() - motion.rigid.from_m).norm();
    motion.reach_m = std::max(motion.reach_m, arm_m);
    span_m = std::max(span_m, 2.0 * arm_m);
  }
  motion.rest.resize(begin == shape.eliminated ? shape.nb : shape.ne + shape.nb);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const int dim = state.variable(variables[i]).dim;
    const Eigen::Vector3d moved = now[i] - motion.rigid(was[i], dim);
    motion.rest.segment<2>(row) = motion.rigid.R.transpose() * moved.head<2>();
    double rest_m = moved.head<2>().norm();
    if (dim == 3) motion.rest[row + 2] = core::wrap_to_pi(moved.z());
    if (is_far_frame(state, variables[i], now.size())) {
      rest_of_far_frame(was[i].head<2>(), row, motion);
      rest_m = motion.world.off_m.norm();
    }
    if (dim == 3) rest_m = std::max(rest_m, span_m * std::abs(motion.rest[row + 2]));
    motion.rest_m = std::max(motion.rest_m, rest_m);
    row += dim;
  }
  motion.bend_m = motion.rest_m * motion.rest_m / span_m;
  return motion;
}

Motion motion_of_boundary(const State& state, int node) {
  const FrontShape& shape = *state.node(node).shape;
  return motion_of(state, shape, shape.eliminated, state.node(node).front->linearised_at.data() + shape.eliminated,
                   values_of(state, shape, shape.eliminated, static_cast<int>(shape.variables.size())));
}

Eigen::VectorXd gradient_of_turn(const State& state, int node, const Motion& motion) {
  const FrontShape& shape = *state.node(node).shape;
  const Values& linearised_at = state.node(node).front->linearised_at;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(motion.rest.size());
  double weight = 0.0;
  Eigen::Index row = 0;
  for (std::size_t i = State::index(shape.eliminated); i < shape.variables.size(); ++i) {
    const int dim = state.variable(shape.variables[i]).dim;
    const Eigen::Vector3d& was = linearised_at[i];
    const Eigen::Vector3d& now = state.value(shape.variables[i]);
    if (shape.boundary() == 1 || shape.variables[i] != state.world) {
      const Eigen::Vector2d p = motion.rigid.R * (was.head<2>() - motion.rigid.from_m);
      gradient.segment<2>(row) << -p.y(), p.x();
      weight += p.dot(now.head<2>() - motion.rigid.to_m);
      if (dim == 3) {
        gradient[row + 2] = std::cos(now.z() - was.z() - motion.rigid.turn_rad);
        weight += gradient[row + 2];
      }
    }
    row += dim;
  }
  return gradient / weight;
}

}  // namespace helixnav::atlas
