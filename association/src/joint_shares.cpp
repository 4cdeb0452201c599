// SPDX-License-Identifier: BSD-3-Clause
#include "joint_shares.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/association/joint_innovation.hpp"
#include "not_positive_definite.hpp"

namespace helixnav::association {
namespace {

Eigen::Index row_of(std::size_t index) { return 2 * static_cast<Eigen::Index>(index); }

}  // namespace

JointShares::JointShares(const InnovationProblem& problem, const std::vector<int>& pairs)
    : is_out_(pairs.size(), char{0}), shares_(pairs.size(), 0.0) {
  const JointInnovation joint = joint_innovation(problem, pairs);
  const Eigen::LLT<Eigen::MatrixXd> llt(joint.S);
  if (llt.info() != Eigen::Success) throw_not_positive_definite(problem, pairs);
  S_inverse_ = llt.solve(Eigen::MatrixXd::Identity(joint.S.rows(), joint.S.cols()));
  r_ = S_inverse_ * joint.nu;
  find_shares();
}

std::size_t JointShares::worst() const {
  return static_cast<std::size_t>(std::max_element(shares_.begin(), shares_.end()) - shares_.begin());
}

/// The inverse of S without a row and column is what is left of S⁻¹ when the block there has been swept out.
double JointShares::drop(std::size_t index) {
  const double share = shares_[index];
  const Eigen::Index row = row_of(index);
  const Eigen::Matrix<double, Eigen::Dynamic, 2> columns = S_inverse_.middleCols<2>(row);
  const Eigen::Matrix2d swept = columns.middleRows<2>(row).inverse();
  r_ -= columns * (swept * r_.segment<2>(row));
  S_inverse_.noalias() -= (columns * swept) * columns.transpose();
  S_inverse_.middleCols<2>(row).setZero();
  S_inverse_.middleRows<2>(row).setZero();
  r_.segment<2>(row).setZero();
  is_out_[index] = 1;
  find_shares();
  return share;
}

void JointShares::find_shares() {
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    const Eigen::Vector2d r = r_.segment<2>(row_of(i));
    shares_[i] = is_out_[i] ? 0.0 : r.dot(S_inverse_.block<2, 2>(row_of(i), row_of(i)).inverse() * r);
  }
}

}  // namespace helixnav::association
