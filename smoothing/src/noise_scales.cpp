// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/noise_scales.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::smoothing {
namespace {

enum class Kind { odometry, landmarks };

std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

void draw_odometry(Problem& problem, bool noisy, core::RandomStream& random) {
  for (auto& edge : problem.graph.pose_edges) {
    const core::Pose2 moved = core::between(problem.graph.poses[index_of(edge.from)].T_world_robot,
                                            problem.graph.poses[index_of(edge.to)].T_world_robot);
    const Eigen::Vector3d noise = noisy ? random.normal3(edge.covariance) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    edge.T_from_to = core::Pose2(Eigen::Vector3d(moved.vector() + noise));
  }
}

void draw_landmarks(Problem& problem, bool noisy, core::RandomStream& random) {
  for (auto& edge : problem.graph.landmark_edges) {
    core::Observation& z = edge.observation;
    z.z = core::predict_observation(z.kind, problem.graph.poses[index_of(edge.pose)].T_world_robot, edge.T_robot_sensor,
                                    problem.graph.landmarks[index_of(edge.landmark)].point_m)
              .z_hat;
    if (!noisy) continue;
    const core::ObsVector predicted = z.z;
    core::ObsVector normal(z.z.size());
    for (Eigen::Index row = 0; row < normal.size(); ++row) normal[row] = random.normal();
    z.z += Eigen::MatrixXd(Eigen::MatrixXd(z.R).llt().matrixL()) * normal;
    const bool has_range = z.kind == core::ObservationKind::range_bearing || z.kind == core::ObservationKind::range;
    if (has_range && !(z.z[0] > 0.0)) z.z = 2.0 * predicted - z.z;  // as likely, and a range
  }
}

Eigen::Vector2d by_kind(const Chi2& chi2) { return {chi2.odometry, chi2.landmarks}; }

/// χ² of both kinds where only measurements of one are in error, in the mean of the draws: a column of S.
Eigen::Vector2d column(const Problem& solved, Kind kind, int draws, core::RandomStream& random,
                       const Options& options) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < draws; ++i) {
    Problem drawn = solved;
    draw_odometry(drawn, kind == Kind::odometry, random);
    draw_landmarks(drawn, kind == Kind::landmarks, random);
    sum += by_kind(optimize(drawn, options).chi2);
  }
  return sum / draws;
}

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

NoiseScales estimate_noise_scales(const Problem& solved, std::uint64_t seed, int draws, const Options& options) {
  if (draws < 1 || solved.graph.pose_edges.empty() || solved.graph.landmark_edges.empty()) {
    throw core::PreconditionError("estimate_noise_scales: needs odometry, landmark observations and at least one draw");
  }
  Options near = options;
  near.first_damping = 1e-8;
  core::RandomStream random(seed, "noise scales");
  const Eigen::Vector2d q = by_kind(evaluate_chi2(solved));
  Eigen::Matrix2d S;
  S.col(0) = column(solved, Kind::odometry, draws, random, near);
  S.col(1) = column(solved, Kind::landmarks, draws, random, near);
  const Eigen::Vector2d redundancy = S.rowwise().sum();
  S(0, 1) = S(1, 0) = 0.5 * (S(0, 1) + S(1, 0));
  Eigen::Vector2d variances = S.inverse() * q;
  if (!(S(0, 0) > 0.0 && S(1, 1) > 0.0 && S.determinant() > 1e-6 * S(0, 0) * S(1, 1))) {
    throw core::NumericalError("estimate_noise_scales: odometry and observations cannot be told apart");
  }
  // A small sample may ask for a negative variance: then each kind is judged alone.
  if (!(variances.minCoeff() > 0.0)) variances = q.cwiseQuotient(redundancy);
  const Eigen::Matrix2d C = 2.0 * S.inverse();
  return {scale_of(variances[0], C(0, 0), redundancy[0]), scale_of(variances[1], C(1, 1), redundancy[1])};
}

}  // namespace helixnav::smoothing
