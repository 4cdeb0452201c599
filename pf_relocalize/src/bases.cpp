// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/bases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "helixnav/core/errors.hpp"

namespace helixnav::pf_relocalize {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr std::size_t origins_tried = 16;

Vector2d turned_left(const Vector2d& v) { return {-v.y(), v.x()}; }

const Vector2d& point(const core::JointGaussian& joint, int i) { return joint.points_m[static_cast<std::size_t>(i)]; }

Matrix2d cross(const core::JointGaussian& joint, int i, int j) {
  return joint.covariance.block<2, 2>(3 + 2 * i, 3 + 2 * j);
}

/// Cov(δm_i − δm_A, δm_j − δm_A).
Matrix2d relative_cross(const core::JointGaussian& joint, int i, int j, int a) {
  return cross(joint, i, j) - cross(joint, i, a) - cross(joint, a, j) + cross(joint, a, a);
}

int landmark_count(const core::JointGaussian& joint) { return static_cast<int>(joint.points_m.size()); }

/// Origins in the order of Σ_i tr Cov(δm_i − δm_A): well observed, and sharing their error with the rest.
std::vector<int> best_origins(const core::JointGaussian& joint) {
  const int n = landmark_count(joint);
  std::vector<double> cost(static_cast<std::size_t>(n), 0.0);
  double own = 0.0;
  for (int i = 0; i < n; ++i) own += cross(joint, i, i).trace();
  for (int a = 0; a < n; ++a) {
    double shared = 0.0;
    for (int i = 0; i < n; ++i) shared += cross(joint, i, a).trace();
    cost[static_cast<std::size_t>(a)] = own - 2.0 * shared + n * cross(joint, a, a).trace();
  }
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return cost[static_cast<std::size_t>(i)] < cost[static_cast<std::size_t>(j)]; });
  order.resize(std::min(order.size(), origins_tried));
  return order;
}

/// δα = lever·(δm_B − δm_A), the rotation of the frame by errors of its bases.
Vector2d heading_lever(const core::JointGaussian& joint, const Bases& bases) {
  const Vector2d d = point(joint, bases.b) - point(joint, bases.a);
  return turned_left(d) / d.squaredNorm();
}

/// mean_relative_variance_m2 of all bases with one origin: the sums over the landmarks that do not depend on the second base
/// are formed once, O(n²), and each base costs O(1).
class SharedOrigin {
 public:
  SharedOrigin(const core::JointGaussian& joint, int a) : joint_(joint), a_(a) {
    const int n = landmark_count(joint);
    Eigen::RowVectorXd swings(2 * n);
    for (int i = 0; i < n; ++i) {
      const Vector2d swing = turned_left(point(joint, i) - point(joint, a));
      swings.segment<2>(2 * i) = swing;
      sum_ += swing;
      squares_ += swing.squaredNorm();
      own_ += relative_cross(joint, i, i, a).trace();
    }
    with_all_ = swings * joint.covariance.bottomRightCorner(2 * n, 2 * n);
  }

  double mean_variance_m2(int b) const {
    const Vector2d lever = heading_lever(joint_, {a_, b});
    const double heading_variance = lever.dot(relative_cross(joint_, b, b, a_) * lever);
    const Eigen::RowVector2d with_base = with_all_.segment<2>(2 * b) - with_all_.segment<2>(2 * a_) -
                                         sum_.transpose() * (cross(joint_, a_, b) - cross(joint_, a_, a_));
    return (own_ - 2.0 * with_base.dot(lever) + squares_ * heading_variance) / landmark_count(joint_);
  }

 private:
  const core::JointGaussian& joint_;
  int a_;
  double own_ = 0.0;                 ///< Σ tr Cov(δm_i − δm_A)
  double squares_ = 0.0;             ///< Σ |s_i|², s_i the direction in which a landmark swings about A
  Vector2d sum_ = Vector2d::Zero();  ///< Σ s_i
  Eigen::RowVectorXd with_all_;      ///< Σ s_iᵀ·P_ij for each j
};

void check(const core::JointGaussian& joint, const Bases& bases) {
  const int n = landmark_count(joint);
  const bool valid = bases.a >= 0 && bases.a < n && bases.b >= 0 && bases.b < n && bases.a != bases.b &&
                     joint.covariance.rows() == 3 + 2 * n && joint.covariance.cols() == 3 + 2 * n;
  if (!valid || (point(joint, bases.a) - point(joint, bases.b)).norm() < 1e-6) {
    throw core::PreconditionError("base frame: two different landmarks and a (3+2n) x (3+2n) covariance are needed");
  }
}

/// J·M for the Jacobian J of the change of frame; M has the rows of the joint state. Column after column, as they lie in memory.
Eigen::MatrixXd apply_jacobian(const core::JointGaussian& joint, const Bases& bases,
                               const core::JointGaussian& relative, const Eigen::MatrixXd& M) {
  const Matrix2d R_base_world = core::rotation(-base_frame(joint, bases).heading_rad);
  const Vector2d lever = heading_lever(joint, bases);
  Eigen::MatrixXd out(M.rows(), M.cols());
  for (Eigen::Index column = 0; column < M.cols(); ++column) {
    const auto from = M.col(column);
    auto to = out.col(column);
    const Vector2d of_a = from.segment<2>(3 + 2 * bases.a);
    const double dalpha = lever.dot(from.segment<2>(3 + 2 * bases.b) - of_a);
    const auto carry = [&](Eigen::Index row, const Vector2d& point_m) {
      const Vector2d moved = R_base_world * (from.segment<2>(row) - of_a);
      to.segment<2>(row) = moved - turned_left(point_m) * dalpha;
    };
    carry(0, relative.pose.position_m());
    to(2) = from(2) - dalpha;
    for (int i = 0; i < landmark_count(joint); ++i) carry(3 + 2 * i, point(relative, i));
  }
  return out;
}

}  // namespace

core::Pose2 base_frame(const core::JointGaussian& joint, const Bases& bases) {
  const Vector2d d = point(joint, bases.b) - point(joint, bases.a);
  return {point(joint, bases.a).x(), point(joint, bases.a).y(), std::atan2(d.y(), d.x())};
}

double mean_relative_variance_m2(const core::JointGaussian& joint, const Bases& bases) {
  check(joint, bases);
  const Vector2d lever = heading_lever(joint, bases);
  const double heading_variance = lever.dot(relative_cross(joint, bases.b, bases.b, bases.a) * lever);
  double sum = 0.0;
  for (int i = 0; i < landmark_count(joint); ++i) {
    const Vector2d swing = turned_left(point(joint, i) - point(joint, bases.a));
    sum += relative_cross(joint, i, i, bases.a).trace() -
           2.0 * swing.dot(relative_cross(joint, i, bases.b, bases.a) * lever) + swing.squaredNorm() * heading_variance;
  }
  return sum / landmark_count(joint);
}

Bases choose_bases(const core::JointGaussian& joint) {
  if (landmark_count(joint) < 2) throw core::PreconditionError("choose_bases: at least two landmarks are needed");
  Bases best;
  double least = std::numeric_limits<double>::infinity();
  for (const int a : best_origins(joint)) {
    const SharedOrigin origin(joint, a);
    for (int b = 0; b < landmark_count(joint); ++b) {
      if (b == a || (point(joint, a) - point(joint, b)).norm() < 1e-6) continue;
      const double variance = origin.mean_variance_m2(b);
      if (variance < least) {
        least = variance;
        best = {a, b};
      }
    }
  }
  return best;
}

MarginalsInBaseFrame marginals_in_base_frame(const core::JointGaussian& joint, const Bases& bases) {
  check(joint, bases);
  const core::Pose2 T_base_world = core::inverse(base_frame(joint, bases));
  const Matrix2d R_base_world = core::rotation(T_base_world.heading_rad);
  const Vector2d lever = heading_lever(joint, bases);
  const Eigen::Index a = 3 + 2 * bases.a, b = 3 + 2 * bases.b;
  // Rows of a point by itself, A and B; a pose has its heading besides.
  const auto rows_of_point = [&](const Vector2d& point_m) {
    const Matrix2d turned = turned_left(point_m) * lever.transpose();
    Eigen::Matrix<double, 2, 6> J;
    J << R_base_world, turned - R_base_world, -turned;
    return J;
  };
  MarginalsInBaseFrame marginals;
  marginals.pose.mean = core::compose(T_base_world, joint.pose);
  const Eigen::Matrix<double, 2, 6> of_position = rows_of_point(marginals.pose.mean.position_m());
  Eigen::Matrix<double, 3, 7> J;
  J << of_position.leftCols<2>(), Vector2d::Zero(), of_position.rightCols<4>(),  //
      0.0, 0.0, 1.0, lever.transpose(), -lever.transpose();
  const std::array<Eigen::Index, 7> with_pose{0, 1, 2, a, a + 1, b, b + 1};
  marginals.pose.covariance = J * joint.covariance(with_pose, with_pose) * J.transpose();
  for (int i = 0; i < landmark_count(joint); ++i) {
    const Vector2d point_m = core::transform(T_base_world, point(joint, i));
    const Eigen::Matrix<double, 2, 6> of_point = rows_of_point(point_m);
    const Eigen::Index own = 3 + 2 * i;
    const std::array<Eigen::Index, 6> with_own{own, own + 1, a, a + 1, b, b + 1};
    marginals.points.push_back({point_m, of_point * joint.covariance(with_own, with_own) * of_point.transpose()});
  }
  return marginals;
}

core::JointGaussian in_base_frame(const core::JointGaussian& joint, const Bases& bases) {
  check(joint, bases);
  const core::Pose2 T_base_world = core::inverse(base_frame(joint, bases));
  core::JointGaussian relative;
  relative.ids = joint.ids;
  relative.pose = core::compose(T_base_world, joint.pose);
  for (const Vector2d& m : joint.points_m) relative.points_m.push_back(core::transform(T_base_world, m));
  const Eigen::MatrixXd JP = apply_jacobian(joint, bases, relative, joint.covariance);
  const Eigen::MatrixXd JPJt = apply_jacobian(joint, bases, relative, JP.transpose());
  relative.covariance = 0.5 * (JPJt + JPJt.transpose());
  return relative;
}

}  // namespace helixnav::pf_relocalize
