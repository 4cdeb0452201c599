// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include "phase/rigid_fit.hpp"
#include "solve/eliminate.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

/// The lower triangle of a message with its right-hand side as last row.
class Message {
 public:
  Message(const std::vector<double>& data, Index rows) : data_(data.data()), rows_(rows) {}

  /// Element (0, j) of a column whose elements above the diagonal are not stored.
  const double* column(Index j) const { return data_ + j * rows_ - j * (j + 1) / 2; }

  Eigen::VectorXd product(const Eigen::VectorXd& e) const {
    const Index n = rows_ - 1;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
    for (Index j = 0; j < n; ++j) {
      const Eigen::Map<const Eigen::VectorXd> below(column(j) + j + 1, n - j - 1);
      sum[j] += column(j)[j] * e[j] + below.dot(e.tail(n - j - 1));
      sum.tail(n - j - 1) += e[j] * below;
    }
    return sum;
  }

 private:
  const double* data_;
  Index rows_;
};

struct Rows {
  std::vector<Index> from;  ///< first row of each variable in the message
  std::vector<Index> dim;
};

/// rest turned by a right angle: how it moves in the frame linearised in, against the turn of that frame.
Eigen::VectorXd turned_rest(const Motion& motion, const Rows& rows) {
  Eigen::VectorXd turned = Eigen::VectorXd::Zero(motion.rest.size());
  for (const Index row : rows.from) {
    const Eigen::Vector2d rest_m = row == motion.world.row ? motion.world.off_m : motion.rest.segment<2>(row).eval();
    turned.segment<2>(row) << -rest_m.y(), rest_m.x();
  }
  return turned;
}

/// The rows of a right-hand side by the present values: the far frame's heading moves its point at the part's centre, too.
void turn_far_frame(const FarFrame& world, Eigen::VectorXd& rhs) {
  if (world.row >= 0) rhs[world.row + 2] += world.lever_m.dot(rhs.segment<2>(world.row));
}

/// The same for a message: TᵀΛT, T the identity except for the lever above the heading's diagonal.
std::vector<double> turn_far_frame(const FarFrame& world, std::vector<double> data, Index rows) {
  const auto at = [&](Index i, Index j) -> double& {
    return data[static_cast<std::size_t>(std::min(i, j) * rows - std::min(i, j) * (std::min(i, j) + 1) / 2 +
                                         std::max(i, j))];
  };
  const Index h = world.row + 2;
  for (int axis = 0; axis < 2; ++axis) {
    const Index from = world.row + axis;
    const double lever_m = world.lever_m[axis];
    const double twice = lever_m * (2.0 * at(h, from) + lever_m * at(from, from));
    for (Index i = 0; i < rows; ++i) {
      if (i != h) at(h, i) += lever_m * at(from, i);
    }
    at(h, h) += twice;
  }
  return data;
}

/// What is not rigid turns with the frame that it is measured in. That term of the Jacobian, E = Dᵀ − (J·rest)·fᵀ with f the gradient
/// of the fit's angle, makes a rigid motion from where the part is now an exact null vector of EᵀΛE; without it every bent part would
/// hold the heading of the whole slightly, and thousands of them held it more firmly than the drive determines it.
void let_turn(const Eigen::VectorXd& f, const Eigen::VectorXd& turned_pull, double weight, const std::vector<Index>& to,
              Eigen::Map<Eigen::MatrixXd> F) {
  for (std::size_t j = 0; j < to.size(); ++j) {
    const auto at_j = static_cast<Index>(j);
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (to[i] < to[j]) continue;
      const auto at_i = static_cast<Index>(i);
      F(to[i], to[j]) -= turned_pull[at_i] * f[at_j] + f[at_i] * (turned_pull[at_j] - weight * f[at_j]);
    }
  }
}

void turn_pairs(Eigen::Ref<Eigen::MatrixXd> block, const Eigen::Matrix2d& R, const Rows& rows, std::size_t first) {
  for (Index j = 0; j < block.cols(); ++j) {
    double* column = &block(0, j);
    for (std::size_t k = first; k < rows.from.size(); ++k) {
      double* pair = column + (rows.from[k] - rows.from[first]);
      const double x = pair[0];
      const double y = pair[1];
      pair[0] = R(0, 0) * x + R(0, 1) * y;
      pair[1] = R(1, 0) * x + R(1, 1) * y;
    }
  }
}

/// Columns of one variable, from its diagonal down, diagonal block filled on both sides.
void copy_columns(const Message& message, Index from, Index dim, Index n, Eigen::MatrixXd& block) {
  for (Index j = 0; j < dim; ++j) {
    const double* column = message.column(from + j);
    for (Index i = j; i < n - from; ++i) block(i, j) = column[from + i];
  }
  for (Index j = 1; j < dim; ++j) {
    for (Index i = 0; i < j; ++i) block(i, j) = block(j, i);
  }
}

/// Adds the columns of one variable of a message where its rows are in the parent.
void add_columns(const Eigen::MatrixXd& block, const Rows& rows, std::size_t c, const std::vector<int>& offsets,
                 Eigen::Map<Eigen::MatrixXd> F) {
  for (Index j = 0; j < rows.dim[c]; ++j) {
    const Index to_column = offsets[c] + j;
    for (Index i = j; i < rows.dim[c]; ++i) F(to_column + i - j, to_column) += block(i, j);
    for (std::size_t r = c + 1; r < offsets.size(); ++r) {
      const double* from = &block(rows.from[r] - rows.from[c], j);
      if (offsets[r] > offsets[c]) {
        for (Index i = 0; i < rows.dim[r]; ++i) F(offsets[r] + i, to_column) += from[i];
      } else {
        for (Index i = 0; i < rows.dim[r]; ++i) F(to_column, offsets[r] + i) += from[i];
      }
    }
  }
}

}  // namespace

void add_message(const State& state, int child, const Motion& motion, const std::vector<int>& offsets,
                 Eigen::Map<Eigen::MatrixXd> F) {
  const TreeNode& node = state.node(child);
  const FrontShape& shape = *node.shape;
  const Index n = shape.nb;
  const Index last = F.rows() - 1;
  Message message(node.front->message, n + 1);
  Eigen::VectorXd rhs(n);
  for (Index j = 0; j < n; ++j) rhs[j] = message.column(j)[n];
  double chi2 = message.column(n)[n];
  if (motion.rest.size() > 0) {
    const Eigen::VectorXd pull = message.product(motion.rest);
    chi2 += motion.rest.dot(pull) - 2.0 * rhs.dot(motion.rest);
    rhs -= pull;
  }
  Rows rows;
  for (std::size_t k = State::index(shape.eliminated); k < shape.variables.size(); ++k) {
    rows.from.push_back(shape.offsets[k] - shape.ne);
    rows.dim.push_back(state.variable(shape.variables[k]).dim);
  }
  const Eigen::Matrix2d& R = motion.rigid.R;
  if (motion.rest.size() > 0) {
    const Eigen::VectorXd turned = turned_rest(motion, rows);
    Eigen::VectorXd pull = message.product(turned);
    const double weight = turned.dot(pull);
    turn_far_frame(motion.world, pull);
    std::vector<Index> to;
    for (std::size_t c = 0; c < offsets.size(); ++c) {
      pull.segment<2>(rows.from[c]) = R * pull.segment<2>(rows.from[c]).eval();
      for (Index i = 0; i < rows.dim[c]; ++i) to.push_back(offsets[c] + i);
    }
    const Eigen::VectorXd turning = gradient_of_turn(state, child, motion);
    let_turn(turning, pull, weight, to, F);
    const double turn_pull = turned.dot(rhs);
    for (std::size_t i = 0; i < to.size(); ++i) F(last, to[i]) -= turning[static_cast<Index>(i)] * turn_pull;
  }
  std::vector<double> turned_message;
  if (motion.world.row >= 0) {
    turned_message = turn_far_frame(motion.world, node.front->message, n + 1);
    message = Message(turned_message, n + 1);
    turn_far_frame(motion.world, rhs);
  }
  Eigen::MatrixXd block(n, 3);
  for (std::size_t c = 0; c < offsets.size(); ++c) {
    copy_columns(message, rows.from[c], rows.dim[c], n, block);
    if (!motion.rigid.is_identity) {
      auto columns = block.topLeftCorner(n - rows.from[c], rows.dim[c]);
      columns.leftCols<2>() *= R.transpose();
      turn_pairs(columns, R, rows, c);
      rhs.segment<2>(rows.from[c]) = R * rhs.segment<2>(rows.from[c]).eval();
    }
    add_columns(block, rows, c, offsets, F);
    for (Index j = 0; j < rows.dim[c]; ++j) F(last, offsets[c] + j) += rhs[rows.from[c] + j];
  }
  F(last, last) += chi2;
}

}  // namespace helixnav::atlas
