// SPDX-License-Identifier: BSD-3-Clause
#include "solve/eliminate.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "helixnav/core/errors.hpp"
#include "phase/world_form.hpp"
#include "solve/partial_cholesky.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

/// The measurements leave the atlas' own frame free, so that any weight gives the same map.
constexpr double gauge_weight = 1e8;

int row_of(const FrontShape& shape, int variable) {
  const auto begin = shape.variables.begin();
  const auto middle = begin + shape.eliminated;
  auto found = std::lower_bound(begin, middle, variable);
  if (found == middle || *found != variable) found = std::lower_bound(middle, shape.variables.end(), variable);
  return shape.offsets[static_cast<std::size_t>(found - begin)];
}

/// Two rows of a factor may belong to one variable, after a merge.
void add_part(const State& state, const Part& part, const FrontShape& shape, Eigen::Map<Eigen::MatrixXd> F) {
  Values values;
  std::vector<Index> to;
  for (const int v : part.variables) {
    values.push_back(state.value(v));
    const int row = row_of(shape, v);
    for (int i = 0; i < state.variable(v).dim; ++i) to.push_back(row + i);
  }
  to.push_back(F.rows() - 1);
  Eigen::MatrixXd A = world_form(*part.gaussian, values);
  if (part.weight != 1.0) A *= part.weight;
  for (std::size_t j = 0; j < to.size(); ++j) {
    for (std::size_t i = j; i < to.size(); ++i) {
      const double a = A(static_cast<Index>(i), static_cast<Index>(j));
      F(std::max(to[i], to[j]), std::min(to[i], to[j])) += i != j && to[i] == to[j] ? 2.0 * a : a;
    }
  }
}

void hold_gauge(const State& state, const FrontShape& shape, Eigen::Map<Eigen::MatrixXd> F) {
  F.diagonal().segment<3>(row_of(shape, gauge_of(state))).array() += gauge_weight;
}

/// The smallest disk around two.
Disk join(const Disk& a, const Disk& b) {
  if (a.radius_m < 0.0) return b;
  if (b.radius_m < 0.0) return a;
  const Eigen::Vector2d apart_m = b.center_m - a.center_m;
  const double distance_m = apart_m.norm();
  if (distance_m + b.radius_m <= a.radius_m) return a;
  if (distance_m + a.radius_m <= b.radius_m) return b;
  Disk both;
  both.radius_m = 0.5 * (distance_m + a.radius_m + b.radius_m);
  both.center_m = a.center_m + (both.radius_m - a.radius_m) / distance_m * apart_m;
  return both;
}

Disk disk_of_eliminated(const State& state, const FrontShape& shape, const Front& front) {
  Eigen::AlignedBox2d box;
  for (int i = 0; i < shape.eliminated; ++i) {
    if (state.variable(shape.variables[State::index(i)]).dim == 2) {
      box.extend(front.linearised_at[State::index(i)].head<2>());
    }
  }
  if (box.isEmpty()) return {};
  return {box.center(), 0.5 * box.diagonal().norm()};
}

Disk moved(Disk disk, const Motion& motion) {
  if (disk.radius_m < 0.0) return disk;
  disk.center_m = motion.rigid.point(disk.center_m);
  disk.radius_m += motion.rest_m;
  return disk;
}

[[noreturn]] void throw_undetermined(const State& state, const FrontShape& shape) {
  std::string names;
  for (int i = 0; i < std::min(shape.eliminated, 3); ++i) {
    const Variable& v = state.variable(shape.variables[State::index(i)]);
    names += (i == 0 ? "" : ", ") + std::string(v.dim == 3 ? "clone " : "landmark ") + std::to_string(v.name);
  }
  throw core::NumericalError("atlas: not positive definite where " + names +
                             (shape.eliminated > 3 ? " and others are eliminated" : " is eliminated"));
}

}  // namespace

Eigen::Map<Eigen::MatrixXd> Workspace::zero_square(Index rows) {
  const std::size_t size = static_cast<std::size_t>(rows * rows);
  if (buffer_.size() < size) buffer_.resize(size);
  std::fill_n(buffer_.begin(), size, 0.0);
  return {buffer_.data(), rows, rows};
}

int gauge_of(const State& state) {
  const FrontShape& shape = *state.node(state.root).shape;
  int i = shape.eliminated - 1;
  while (i > 0 && state.variable(shape.variables[State::index(i)]).dim != 3) --i;
  return shape.variables[State::index(i)];
}

void eliminate(State& state, int id, Workspace& workspace) {
  const TreeNode& node = state.node(id);
  const FrontShape& shape = *node.shape;
  const Index ne = shape.ne;
  const Index nb = shape.nb;
  auto front = std::make_shared<Front>();
  front->linearised_at = values_of(state, shape, 0, static_cast<int>(shape.variables.size()));
  front->landmarks = disk_of_eliminated(state, shape, *front);
  Eigen::Map<Eigen::MatrixXd> F = workspace.zero_square(ne + nb + 1);
  if (node.phase >= 0) {
    for (const Part& part : state.leaf(node.phase).parts) add_part(state, part, shape, F);
  } else {
    for (std::size_t c = 0; c < 2; ++c) {
      const Motion motion = motion_of_boundary(state, node.child[c]);
      add_message(state, node.child[c], motion, shape.from_child[c], F);
      front->child_turn_rad[c] = motion.rigid.turn_rad;
      front->landmarks = join(front->landmarks, moved(state.node(node.child[c]).front->landmarks, motion));
    }
  }
  if (id == state.root) hold_gauge(state, shape, F);
  if (!partial_cholesky(F, ne)) throw_undetermined(state, shape);
  front->L = F.leftCols(ne);
  front->message.reserve(static_cast<std::size_t>((nb + 1) * (nb + 2) / 2));
  for (Index j = 0; j <= nb; ++j) {
    const double* column = &F(ne + j, ne + j);
    front->message.insert(front->message.end(), column, column + (nb + 1 - j));
  }
  TreeNode& written = state.nodes.write(State::index(id));
  written.front = std::move(front);
  written.opened_at = nullptr;
  written.dirty = false;
  written.fresh = true;
}

}  // namespace helixnav::atlas
