// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/joint_innovation.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "costs.hpp"
#include "not_positive_definite.hpp"

namespace helixnav::association {

Eigen::Matrix2d innovation_cross_covariance(const InnovationProblem& problem, const GatedPair& a, const GatedPair& b) {
  if (a.observation == b.observation && a.candidate == b.candidate) return a.S;
  const Prediction& p = problem.predictions[a.prediction];
  const Prediction& q = problem.predictions[b.prediction];
  Eigen::Matrix2d C = Eigen::Matrix2d::Zero();
  if (problem.covariance != nullptr) {
    const Eigen::Matrix2d P_mm = problem.covariance->block<2, 2>(3 + 2 * p.candidate, 3 + 2 * q.candidate);
    C = p.C_pose * q.H_pose.transpose() + p.H_pose * q.P_vm_Hm + p.H_landmark * P_mm * q.H_landmark.transpose();
  } else if (p.candidate == q.candidate) {
    C = p.H_landmark * q.P_mm_Hm;
  }
  if (a.observation == b.observation) C += a.S - p.HPHt;
  return C;
}

JointInnovation joint_innovation(const InnovationProblem& problem, const std::vector<int>& pairs) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  JointInnovation joint;
  joint.nu.resize(2 * n);
  joint.S.resize(2 * n, 2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const GatedPair& a = problem.pairs[pairs[i]];
    joint.dof += a.dof;
    joint.nu.segment<2>(2 * i) = a.nu;
    joint.S.block<2, 2>(2 * i, 2 * i) = a.S;
    for (Eigen::Index j = 0; j < i; ++j) {
      const Eigen::Matrix2d C = innovation_cross_covariance(problem, a, problem.pairs[pairs[j]]);
      joint.S.block<2, 2>(2 * i, 2 * j) = C;
      joint.S.block<2, 2>(2 * j, 2 * i) = C.transpose();
    }
  }
  return joint;
}

JointNis joint_nis(const InnovationProblem& problem, const std::vector<int>& pairs) {
  if (pairs.empty()) return {};
  JointInnovation joint = joint_innovation(problem, pairs);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(joint.S);  // in place
  if (llt.info() != Eigen::Success) throw_not_positive_definite(problem, pairs);
  llt.matrixL().solveInPlace(joint.nu);
  JointNis result;
  result.dof = joint.dof;
  result.nis = joint.nu.squaredNorm();
  const double log_determinant = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  result.log_likelihood = -0.5 * (result.nis + log_determinant + joint.dof * ln_2pi);
  if (!std::isfinite(result.log_likelihood)) throw_not_positive_definite(problem, pairs);
  return result;
}

}  // namespace helixnav::association
