// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/merge_candidates.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "chi2_table.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::association {
namespace {

/// Landmarks i < j of the JointGaussian as one landmark.
struct Pair {
  int i;
  int j;
  Eigen::Vector2d difference_m;
  double nis;
};

/// cov(m_i − m_j, m_k − m_l).
Eigen::Matrix2d difference_covariance(const Eigen::MatrixXd& P, const Pair& a, const Pair& b) {
  const auto block = [&](int i, int k) -> Eigen::Matrix2d { return P.block<2, 2>(3 + 2 * i, 3 + 2 * k); };
  return block(a.i, b.i) - block(a.i, b.j) - block(a.j, b.i) + block(a.j, b.j);
}

double joint_nis(const Eigen::MatrixXd& P, const std::vector<Pair>& pairs) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd S(2 * n, 2 * n);
  Eigen::VectorXd difference(2 * n);
  for (Eigen::Index a = 0; a < n; ++a) {
    difference.segment<2>(2 * a) = pairs[a].difference_m;
    for (Eigen::Index b = 0; b < n; ++b) S.block<2, 2>(2 * a, 2 * b) = difference_covariance(P, pairs[a], pairs[b]);
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  if (llt.info() != Eigen::Success) {
    throw core::NumericalError("merge_candidates: covariance of differences is not positive definite");
  }
  return difference.dot(llt.solve(difference));
}

bool is_mature(const LandmarkLife& life, core::LandmarkId id) { return life.state(id) == core::LandmarkState::mature; }

std::vector<Pair> compatible_pairs(const core::JointGaussian& landmarks, const LandmarkLife& life,
                                   const MergeOptions& options) {
  std::vector<Pair> pairs;
  const double gate = chi2_threshold(options.gate_probability, 2);
  const int n = static_cast<int>(landmarks.ids.size());
  for (int i = 0; i < n; ++i) {
    if (!is_mature(life, landmarks.ids[i])) continue;
    for (int j = i + 1; j < n; ++j) {
      Pair pair{i, j, landmarks.points_m[i] - landmarks.points_m[j], 0.0};
      if (pair.difference_m.norm() > options.max_distance_m || !is_mature(life, landmarks.ids[j])) continue;
      if (life.seen_together(landmarks.ids[i], landmarks.ids[j])) continue;
      pair.nis = joint_nis(landmarks.covariance, {pair});
      if (pair.nis <= gate) pairs.push_back(pair);
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.nis != b.nis ? a.nis < b.nis : std::pair(a.i, a.j) < std::pair(b.i, b.j);
  });
  return pairs;
}

}  // namespace

std::vector<MergeCandidate> merge_candidates(const core::JointGaussian& landmarks, const LandmarkLife& life,
                                             const MergeOptions& options) {
  std::vector<MergeCandidate> candidates;
  std::vector<Pair> accepted;
  std::vector<char> used(landmarks.ids.size(), 0);
  for (const Pair& pair : compatible_pairs(landmarks, life, options)) {
    if (used[pair.i] || used[pair.j]) continue;
    accepted.push_back(pair);
    const double nis = joint_nis(landmarks.covariance, accepted);
    const int dof = 2 * static_cast<int>(accepted.size());
    if (nis > chi2_threshold(options.gate_probability, dof)) {
      accepted.pop_back();
      continue;
    }
    used[pair.i] = used[pair.j] = 1;
    const auto [kept, merged] = std::minmax(landmarks.ids[pair.i], landmarks.ids[pair.j]);
    candidates.push_back({kept, merged, pair.difference_m.norm(), pair.nis, nis, dof});
  }
  return candidates;
}

}  // namespace helixnav::association
