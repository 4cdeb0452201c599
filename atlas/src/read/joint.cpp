// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/mirror_lower.hpp"
#include "helixnav/core/packed_product.hpp"
#include "read/joint.hpp"
#include "read/read.hpp"
#include "solve/partial_cholesky.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// A covariance of the map frame and of others, in memory that can go on to hold the covariance of the others alone: for a large
/// map this is the largest object there is, and there is room for one.
class Joint {
 public:
  explicit Joint(Index size) : size_(size), memory_(size - 3, (size * size + spare_rows) / (size - 3) + 1) {
    // Not all at once: of what is allocated as zero, each page costs one fault to be read and one more to be written.
    for (Index column = 0; column < size; ++column) std::fill(at(column, column), at(0, column + 1), 0.0);
  }

  Index size() const { return size_; }
  double* at(Index row, Index column) { return memory_.data() + row + column * size_; }
  Eigen::Map<MatrixXd> matrix() { return {memory_.data(), size_, size_}; }

  /// Rows and columns in another order, [new] to old.
  void reorder(const std::vector<Index>& old) {
    Eigen::Map<MatrixXd> P = matrix();
    std::vector<bool> is_done(old.size(), false);
    Eigen::VectorXd first(size_), next(size_);
    for (Index begin = 0; begin < size_; ++begin) {
      if (is_done[State::index(begin)]) continue;
      first = P.col(begin)(old);
      Index to = begin;
      while (true) {  // round the cycle of columns
        is_done[State::index(to)] = true;
        const Index from = old[State::index(to)];
        if (from == begin) break;
        next = P.col(from)(old);
        P.col(to) = next;
        to = from;
      }
      P.col(to) = first;
    }
  }

  /// Leaves out the first three rows and columns.
  void drop_first() {
    const Index n = size_ - 3;
    for (Index column = 0; column < n; ++column) {
      const double* from = at(3, column + 3);
      std::copy(from, from + n, memory_.data() + column * n);
    }
    size_ = n;
  }

  /// After drop_first().
  MatrixXd take() {
    memory_.conservativeResize(size_, size_);  // as many rows: nothing moves
    return std::move(memory_);
  }

 private:
  Index size_;
  MatrixXd memory_;
};

/// Forward solves on the union of some paths. Columns are laid out in the order in which the tree reaches their variables,
/// so that those below a node are contiguous.
class PathSolve {
 public:
  /// `variables`: each once.
  PathSolve(const State& state, const std::vector<int>& variables)
      : state_(state), wanted_(variables), P_(rows_of(state, variables)) {
    for (const int v : variables) {
      for (int node = state.variable(v).at; node >= 0; node = state.node(node).parent) marked_.push_back(node);
    }
    std::sort(wanted_.begin(), wanted_.end());
    std::sort(marked_.begin(), marked_.end());
    marked_.erase(std::unique(marked_.begin(), marked_.end()), marked_.end());
  }

  /// Covariance with rows and columns in the order of `variables`, the same as at construction.
  Joint covariance(const std::vector<int>& variables) && {
    solve(state_.root, 0.0);
    std::vector<Index> rows;
    for (const int v : variables) {
      const auto found = std::lower_bound(column_of_.begin(), column_of_.end(), std::make_pair(v, Index{-1}));
      if (found == column_of_.end() || found->first != v) {
        throw core::NumericalError("atlas: nothing determines landmark " + std::to_string(state_.variable(v).name));
      }
      for (int i = 0; i < state_.variable(v).dim; ++i) rows.push_back(found->second + i);
    }
    core::mirror_lower(P_.matrix());
    P_.reorder(rows);
    return std::move(P_);
  }

 private:
  struct Passed {
    Index first = 0;  ///< column
    MatrixXd rows;    ///< on the node's boundary, in its frame
  };

  static Index rows_of(const State& state, const std::vector<int>& variables) {
    Index rows = 0;
    for (const int v : variables) rows += state.variable(v).dim;
    return rows;
  }

  bool is_marked(int node) const { return std::binary_search(marked_.begin(), marked_.end(), node); }

  /// `turn_rad`: from the node's frame to that of the root.
  Passed solve(int id, double turn_rad) {
    const TreeNode& node = state_.node(id);
    const FrontShape& shape = *node.shape;
    std::array<Passed, 2> below;
    const Index first = next_column_;
    for (std::size_t c = 0; c < 2 && node.phase < 0; ++c) {
      if (!is_marked(node.child[c])) continue;
      below[c] = solve(node.child[c], turn_rad + node.front->child_turn_rad[c]);
    }
    const std::vector<int> own = wanted_of(shape);
    MatrixXd F = MatrixXd::Zero(shape.ne + shape.nb + spare_rows, next_column_ - first);
    for (std::size_t c = 0; c < 2; ++c) {
      if (below[c].rows.cols() > 0) add_from_child(node, c, below[c], first, F);
    }
    place(own, shape, turn_rad, first, F);
    if (shape.ne > 0 && F.cols() > 0) {
      solve_down_columns(node.front->L.topRows(shape.ne + shape.nb), F);
      add_gram(F.topRows(shape.ne), P_.at(first, first), P_.size());
    }
    return {first, F.middleRows(shape.ne, shape.nb)};
  }

  /// Wanted variables that a front eliminates, as places in it; they get the next columns.
  std::vector<int> wanted_of(const FrontShape& shape) {
    std::vector<int> own;
    for (int i = 0; i < shape.eliminated; ++i) {
      const int v = shape.variables[State::index(i)];
      if (!std::binary_search(wanted_.begin(), wanted_.end(), v)) continue;
      own.push_back(i);
      const std::pair<int, Index> entry(v, next_column_);
      column_of_.insert(std::lower_bound(column_of_.begin(), column_of_.end(), entry), entry);
      next_column_ += state_.variable(v).dim;
    }
    return own;
  }

  /// Unit columns of the root's frame, in the node's.
  void place(const std::vector<int>& own, const FrontShape& shape, double turn_rad, Index first, MatrixXd& F) const {
    const Eigen::Matrix2d R = core::rotation(-turn_rad);
    for (const int i : own) {
      const int v = shape.variables[State::index(i)];
      const Index row = shape.offsets[State::index(i)];
      const Index column =
          std::lower_bound(column_of_.begin(), column_of_.end(), std::make_pair(v, Index{-1}))->second - first;
      F.block<2, 2>(row, column) = R;
      if (state_.variable(v).dim == 3) F(row + 2, column + 2) = 1.0;
    }
  }

  /// Rows of a variable of the boundary among those passed, and in the front above.
  struct Rows {
    Index from, to;
    bool is_pose;
  };

  std::vector<Rows> boundary_rows(const TreeNode& node, std::size_t c) const {
    const FrontShape& child = *state_.node(node.child[c]).shape;
    std::vector<Rows> boundary;
    for (std::size_t k = 0; k < node.shape->from_child[c].size(); ++k) {
      const std::size_t at = k + State::index(child.eliminated);
      const bool is_pose = state_.variable(child.variables[at]).dim == 3;
      boundary.push_back({child.offsets[at] - child.ne, node.shape->from_child[c][k], is_pose});
    }
    return boundary;
  }

  /// Column after column, as they lie in memory.
  void add_from_child(const TreeNode& node, std::size_t c, const Passed& passed, Index first, MatrixXd& F) const {
    const std::vector<Rows> boundary = boundary_rows(node, c);
    const Eigen::Matrix2d R = core::rotation(node.front->child_turn_rad[c]);
    for (Index column = 0; column < passed.rows.cols(); ++column) {
      const auto source = passed.rows.col(column);
      auto target = F.col(passed.first - first + column);
      for (const Rows& rows : boundary) {
        target.segment<2>(rows.to) += R * source.segment<2>(rows.from);
        if (rows.is_pose) target(rows.to + 2) += source(rows.from + 2);
      }
    }
  }

  const State& state_;
  std::vector<int> wanted_;
  std::vector<int> marked_;
  std::vector<std::pair<int, Index>> column_of_;  ///< increasing by variable
  Index next_column_ = 0;
  Joint P_;
};

/// How values given in the order of rows move with the map frame's own variable: [I, J] for positions, [0, 1] for the heading.
Eigen::Matrix<double, Eigen::Dynamic, 3> carried(const Eigen::Vector3d& world, const Values& values) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> G(2 * static_cast<Index>(values.size()) + 1, 3);
  Index row = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Eigen::Vector3d arm = values[i] - world;
    G.middleRows<2>(row) << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
    row += 2;
    if (i == 0) G.row(row++) << 0.0, 0.0, 1.0;
  }
  return G;
}

/// Errors in another frame, of a covariance given by its lower triangle, of which only that is right afterwards.
void turn_lower(Eigen::Ref<MatrixXd> P, const Eigen::Matrix2d& R) {
  const Index n = P.cols();
  const auto next = [](Index row) { return row == 0 ? 3 : row + 2; };
  for (Index column = 0; column < n; column = next(column)) {
    P(column, column + 1) = P(column + 1, column);
    for (Index row = column; row < n; row = next(row)) {
      const Eigen::Matrix2d turned = R * P.block<2, 2>(row, column);
      P.block<2, 2>(row, column) = turned * R.transpose();
    }
  }
  P.block<1, 2>(2, 0) = (P.block<1, 2>(2, 0) * R.transpose()).eval();
  for (Index row = 3; row < n; row += 2) P.block<2, 1>(row, 2) = (R * P.block<2, 1>(row, 2)).eval();
}

/// Covariance of what is seen from the map frame: errors δ − G·δ_world, turned.
MatrixXd seen_from_world(Joint joint, const Eigen::Vector3d& world, const Values& values, double turn_rad) {
  const Index n = joint.size() - 3;
  const auto G = carried(world, values);
  const MatrixXd cross = joint.matrix().bottomLeftCorner(n, 3) - 0.5 * G * joint.matrix().topLeftCorner<3, 3>();
  joint.drop_first();
  MatrixXd of_pairs(n, 6), with(n, 6);
  of_pairs << -cross, -G;
  with << G, cross;
  core::add_product_lower(joint.at(0, 0), n, core::Panels(of_pairs, core::left_width),
                          core::Panels(with, core::right_width));
  turn_lower(joint.matrix(), core::rotation(turn_rad));
  core::mirror_lower(joint.matrix());
  return joint.take();
}

/// Of the last clone and points, each once; without their names.
core::JointGaussian joint_of(const State& state, const std::vector<int>& points, int last_clone) {
  std::vector<int> variables{last_clone};
  variables.insert(variables.end(), points.begin(), points.end());
  core::JointGaussian joint;
  Estimates estimates(state);
  const core::Pose2 T_map = T_map_atlas(state, estimates);
  Values values;
  for (const int v : variables) values.push_back(estimates.of(v));
  joint.pose = core::compose(T_map, core::Pose2(values[0]));
  for (std::size_t i = 1; i < values.size(); ++i) {
    joint.points_m.push_back(core::transform(T_map, values[i].head<2>()));
  }
  if (state.root < 0) {
    joint.covariance = state.start.covariance;
    return joint;
  }
  variables.insert(variables.begin(), state.world);
  joint.covariance = seen_from_world(PathSolve(state, variables).covariance(variables), estimates(state.world), values,
                                     T_map.heading_rad);
  return joint;
}

/// With rows and columns of points as often as they are asked for, `places` among those of `joint`.
core::JointGaussian repeated(const core::JointGaussian& joint, const std::vector<std::size_t>& places) {
  core::JointGaussian all;
  all.pose = joint.pose;
  std::vector<Index> rows{0, 1, 2};
  for (const std::size_t place : places) {
    all.points_m.push_back(joint.points_m[place]);
    for (int i = 0; i < 2; ++i) rows.push_back(3 + 2 * static_cast<Index>(place) + i);
  }
  all.covariance = joint.covariance(rows, rows);
  return all;
}

}  // namespace

MatrixXd covariance_of(const State& state, const std::vector<int>& variables) {
  return PathSolve(state, variables).covariance(variables).matrix();
}

core::JointGaussian Atlas::joint(const std::vector<core::LandmarkId>& ids) const {
  const State& state = *settled_;
  const int last_clone = state.variable_of_clone[State::index(phase_count())];
  std::vector<int> asked;
  for (const core::LandmarkId id : ids) asked.push_back(variable_of_named(state, id));
  std::vector<int> once = asked;  // the names of merged landmarks refer to one
  std::sort(once.begin(), once.end());
  once.erase(std::unique(once.begin(), once.end()), once.end());
  core::JointGaussian joint;
  if (once.size() == asked.size()) {
    joint = joint_of(state, asked, last_clone);
  } else {
    std::vector<std::size_t> places;
    for (const int v : asked) {
      places.push_back(static_cast<std::size_t>(std::lower_bound(once.begin(), once.end(), v) - once.begin()));
    }
    joint = repeated(joint_of(state, once, last_clone), places);
  }
  joint.ids = ids;
  return joint;
}

}  // namespace helixnav::atlas
