// SPDX-License-Identifier: BSD-3-Clause
#include "association/old_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/association/joint_innovation.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::supervisor {
namespace {

/// A pair and its NIS given two others.
struct NearPair {
  double nis;
  int at;
};

/// All pairs within the gate given `first` and `second`, nearest first.
std::vector<NearPair> near_given(const OldPairs& old, int first, int second) {
  static const double gate = core::chi2_quantile(0.99, 2);
  Eigen::Matrix4d S_two;
  S_two << old.covariance(first, first), old.covariance(first, second), old.covariance(second, first),
      old.covariance(second, second);
  Eigen::Vector4d nu_two;
  nu_two << old.innovation(first), old.innovation(second);
  const Eigen::Matrix4d S_inverse = S_two.inverse();
  const Eigen::Vector4d pull = S_inverse * nu_two;
  std::vector<NearPair> near;
  for (int k = 0; k < old.size(); ++k) {
    if (k == first || k == second) continue;
    Eigen::Matrix<double, 2, 4> C;
    C << old.covariance(k, first), old.covariance(k, second);
    const Eigen::Vector2d nu = old.innovation(k) - C * pull;
    const Eigen::Matrix2d S = old.covariance(k, k) - C * S_inverse * C.transpose();
    const double nis = nu.dot(S.inverse() * nu);
    if (nis >= 0.0 && nis < gate) near.push_back({nis, k});
  }
  std::sort(near.begin(), near.end(),
            [](const NearPair& a, const NearPair& b) { return a.nis != b.nis ? a.nis < b.nis : a.at < b.at; });
  return near;
}

}  // namespace

OldPairs old_pairs_given(const association::InnovationProblem& problem, const std::vector<int>& pairs,
                         const std::vector<int>& given) {
  std::vector<int> all = given;
  all.insert(all.end(), pairs.begin(), pairs.end());
  const association::JointInnovation joint = association::joint_innovation(problem, all);
  const auto g = static_cast<Eigen::Index>(2 * given.size());
  const auto n = static_cast<Eigen::Index>(2 * pairs.size());
  OldPairs old{&problem, pairs, joint.nu.tail(n), joint.S.bottomRightCorner(n, n)};
  if (g == 0) return old;
  const Eigen::LLT<Eigen::MatrixXd> llt(joint.S.topLeftCorner(g, g));
  if (llt.info() != Eigen::Success)
    throw core::NumericalError("innovation covariance of the matched pairs is not positive definite");
  const Eigen::MatrixXd gain = llt.solve(joint.S.topRightCorner(g, n));
  old.nu.noalias() -= gain.transpose() * joint.nu.head(g);
  old.S.noalias() -= joint.S.bottomLeftCorner(n, g) * gain;
  return old;
}

double joint_log_likelihood(const OldPairs& old, const Matching& matching) {
  const auto n = static_cast<Eigen::Index>(matching.size());
  Eigen::VectorXd nu(2 * n);
  Eigen::MatrixXd S(2 * n, 2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int a = matching[static_cast<std::size_t>(i)];
    nu.segment<2>(2 * i) = old.innovation(a);
    for (Eigen::Index j = 0; j < n; ++j) {
      S.block<2, 2>(2 * i, 2 * j) = old.covariance(a, matching[static_cast<std::size_t>(j)]);
    }
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(S);  // in place
  if (llt.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  llt.matrixL().solveInPlace(nu);
  const double log_determinant = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (nu.squaredNorm() + log_determinant + 2.0 * static_cast<double>(n) * std::log(2.0 * core::pi));
}

Matching matching_given(const OldPairs& old, int first, int second) {
  Matching matching;
  std::vector<bool> seen(old.problem->observations.size(), false), met(old.problem->ids.size(), false);
  const auto take = [&](int at) {
    const association::GatedPair& pair = old.at(at);
    const auto observation = static_cast<std::size_t>(pair.observation);
    const auto candidate = static_cast<std::size_t>(pair.candidate);
    if (seen[observation] || met[candidate]) return;
    seen[observation] = met[candidate] = true;
    matching.push_back(at);
  };
  take(first);
  take(second);
  for (const NearPair& near : near_given(old, first, second)) take(near.at);
  std::sort(matching.begin(), matching.end());
  return matching;
}

}  // namespace helixnav::supervisor
