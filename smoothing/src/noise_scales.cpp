// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/noise_scales.hpp"

#include <cmath>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "joint.hpp"
#include "sparse/selected_inverse.hpp"
#include "whitened_rows.hpp"

namespace helixnav::smoothing {
namespace {

/// tr(H⁻¹ΣJᵀJ): how many columns these measurements determine.
double determined_by(const std::vector<WhitenedRows>& all, const SelectedInverse& inverse,
                     const std::vector<int>& position) {
  double trace = 0.0;
  for (const WhitenedRows& one : all) {
    for (int k = 0; k < 6; ++k) {
      if (one.column[sized(k)] < 0) continue;
      const int pk = position[sized(one.column[sized(k)])];
      trace += one.J.col(k).squaredNorm() * inverse.at(pk, pk);
      for (int l = 0; l < k; ++l) {
        if (one.column[sized(l)] < 0) continue;
        trace += 2.0 * one.J.col(k).dot(one.J.col(l)) * inverse.at(pk, position[sized(one.column[sized(l)])]);
      }
    }
  }
  return trace;
}

/// Means of what the solution x of errors of one kind does to the rows of the kinds, and of xᵀHx.
struct Moved {
  double odometry = 0.0, landmarks = 0.0, all = 0.0;
};

/// S of a factorised session. With H = H₁ + H₂ (+ priors) and t_i = tr(H⁻¹H_i), S_ij = δ_ij(n_i − 2t_i) + tr(H⁻¹H_iH⁻¹H_j): the
/// t_i are exact, from the entries of H⁻¹ on the pattern of H; of the rest, which needs all of H⁻¹, only one number is drawn.
class Redundancies {
 public:
  explicit Redundancies(Session& session)
      : session_(session), odometry_(whitened_odometry(session)), landmarks_(whitened_observations(session)) {}

  Eigen::Matrix2d draw(int draws, core::RandomStream& random) {
    const std::vector<int> position = positions(session_);
    const SelectedInverse inverse(session_.cholesky.factor(), position);
    const double by_odometry = determined_by(odometry_, inverse, position);
    const double by_landmarks = determined_by(landmarks_, inverse, position);
    const Moved odometry = moved_by(odometry_, draws, random), landmarks = moved_by(landmarks_, draws, random);
    Eigen::Matrix2d S;
    const double both = 0.5 * (odometry.landmarks + landmarks.odometry);
    // What priors hold fixed is left as drawn; without priors both differences are negligible beside the others.
    const double own_odometry = by_odometry - both - (odometry.all - odometry.odometry - odometry.landmarks);
    const double own_landmarks = by_landmarks - both - (landmarks.all - landmarks.odometry - landmarks.landmarks);
    S << count_rows(odometry_) - 2.0 * by_odometry + own_odometry, both, both,
        count_rows(landmarks_) - 2.0 * by_landmarks + own_landmarks;
    return S;
  }

 private:
  Moved moved_by(const std::vector<WhitenedRows>& kind, int draws, core::RandomStream& random) {
    Moved sum;
    Eigen::VectorXd x, Hx;
    for (int i = 0; i < draws; ++i) {
      const Eigen::VectorXd g = transposed_times(kind, session_.layout.columns, [&random] { return random.normal(); });
      session_.cholesky.solve(g, x);
      sum.odometry += squared_norm_of(odometry_, x) / draws;
      sum.landmarks += squared_norm_of(landmarks_, x) / draws;
      sum.all += x.dot(g) / draws;
    }
    return sum;
  }

  Session& session_;
  std::vector<WhitenedRows> odometry_, landmarks_;
};

NoiseScale scale_of(double variance, double variance_of_variance, double redundancy) {
  NoiseScale scale;
  scale.factor = std::sqrt(variance);
  const double sigma_of_log = 0.5 * std::sqrt(variance_of_variance);  // near a factor of 1, or relative to it
  scale.low_95 = scale.factor * std::exp(-1.96 * sigma_of_log);
  scale.high_95 = scale.factor * std::exp(1.96 * sigma_of_log);
  scale.redundancy = redundancy;
  return scale;
}

}  // namespace

NoiseScales estimate_noise_scales(const Problem& solved, std::uint64_t seed, int draws) {
  if (draws < 1 || solved.graph.pose_edges.empty() || solved.graph.landmark_edges.empty()) {
    throw core::PreconditionError("estimate_noise_scales: needs odometry, landmark observations and at least one draw");
  }
  check_problem(solved);
  const Options options;
  Session session(solved, options);
  session.linearize();
  session.factorize_undamped();
  core::RandomStream random(seed, "noise scales");
  const Eigen::Matrix2d S = Redundancies(session).draw(draws, random);
  const Eigen::Vector2d q(session.chi2.odometry, session.chi2.landmarks);
  const Eigen::Vector2d redundancy = S.rowwise().sum();
  Eigen::Vector2d variances = S.inverse() * q;
  if (!(S(0, 0) > 0.0 && S(1, 1) > 0.0 && S.determinant() > 1e-6 * S(0, 0) * S(1, 1))) {
    throw core::NumericalError("estimate_noise_scales: odometry and observations cannot be told apart");
  }
  // A small sample may ask for a negative variance: each kind is then judged on its own.
  if (!(variances.minCoeff() > 0.0)) variances = q.cwiseQuotient(redundancy);
  const Eigen::Matrix2d C = 2.0 * S.inverse();
  return {scale_of(variances[0], C(0, 0), redundancy[0]), scale_of(variances[1], C(1, 1), redundancy[1])};
}

}  // namespace helixnav::smoothing
