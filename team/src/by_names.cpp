// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "candidates.hpp"
#include "helixnav/core/chi2.hpp"

namespace helixnav::team {
namespace {

using core::LandmarkId;

std::map<std::int64_t, LandmarkId> mature_names(std::size_t component, const JoinOptions& options, const State& state) {
  std::map<std::int64_t, LandmarkId> names;
  for (const auto& [key, id] : state.id_of_name) {
    if (state.robots[key.first].component != component) continue;
    const LandmarkId now = state.resolve(id);
    if (state.observations[static_cast<std::size_t>(now)] >= options.mature_observations) names[key.second] = now;
  }
  return names;
}

/// Points of one map with their joint covariance.
struct Points {
  std::vector<Eigen::Vector2d> at_m;
  Eigen::MatrixXd covariance;
};

Points points_of(const JointFilter& filter, const std::vector<LandmarkId>& ids) {
  Points points;
  std::vector<Eigen::Index> rows;
  for (const LandmarkId id : ids) {
    const auto place = std::find(filter.ids().begin(), filter.ids().end(), id) - filter.ids().begin();
    points.at_m.push_back(filter.points_m()[static_cast<std::size_t>(place)]);
    const auto column = static_cast<Eigen::Index>(3 * filter.robots()) + 2 * static_cast<Eigen::Index>(place);
    rows.insert(rows.end(), {column, column + 1});
  }
  points.covariance = filter.covariance()(rows, rows);
  return points;
}

/// The rigid motion of least squares without weights.
core::Pose2 rigid_fit(const Points& a, const Points& b) {
  Eigen::Vector2d mean_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_b = Eigen::Vector2d::Zero();
  const auto n = static_cast<double>(a.at_m.size());
  for (std::size_t i = 0; i < a.at_m.size(); ++i) {
    mean_a += a.at_m[i] / n;
    mean_b += b.at_m[i] / n;
  }
  double dot = 0.0;
  double cross = 0.0;
  for (std::size_t i = 0; i < a.at_m.size(); ++i) {
    const Eigen::Vector2d da = a.at_m[i] - mean_a;
    const Eigen::Vector2d db = b.at_m[i] - mean_b;
    dot += db.dot(da);
    cross += db.x() * da.y() - db.y() * da.x();
  }
  const double heading_rad = std::atan2(cross, dot);
  const Eigen::Vector2d at_m = mean_a - core::rotation(heading_rad) * mean_b;
  return {at_m.x(), at_m.y(), heading_rad};
}

struct Fit {
  core::PoseGaussian T;
  double chi2 = 0.0;
};

/// min νᵀS⁻¹ν over T, ν = a − T∘b, S = P_a + R P_b Rᵀ.
Fit fit_of(const Points& a, const Points& b) {
  Fit fit;
  fit.T.mean = rigid_fit(a, b);
  const auto n = static_cast<Eigen::Index>(2 * a.at_m.size());
  constexpr int iterations = 5;
  for (int k = 0; k < iterations; ++k) {
    const Eigen::Matrix2d R = core::rotation(fit.T.mean.heading_rad);
    Eigen::MatrixXd turn = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd J(n, 3);
    Eigen::VectorXd nu(n);
    for (Eigen::Index i = 0; i < n; i += 2) {
      const auto point = static_cast<std::size_t>(i / 2);
      const Eigen::Vector2d arm_m = R * b.at_m[point];
      turn.block<2, 2>(i, i) = R;
      J.middleRows<2>(i) << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
      nu.segment<2>(i) = a.at_m[point] - core::transform(fit.T.mean, b.at_m[point]);
    }
    const Eigen::LLT<Eigen::MatrixXd> S(a.covariance + turn * b.covariance * turn.transpose());
    const Eigen::MatrixXd W = S.solve(J);
    const Eigen::Matrix3d H = J.transpose() * W;
    const Eigen::Vector3d step = H.ldlt().solve(W.transpose() * nu);
    fit.T.mean = core::Pose2(fit.T.mean.vector() + step);
    fit.T.covariance = H.inverse();
    fit.chi2 = nu.dot(S.solve(nu)) - step.dot(H * step);
  }
  return fit;
}

}  // namespace

std::optional<Candidate> by_names(std::size_t into, std::size_t from, const JoinOptions& options, const State& state) {
  const std::map<std::int64_t, LandmarkId> ours = mature_names(into, options, state);
  const std::map<std::int64_t, LandmarkId> theirs = mature_names(from, options, state);
  std::vector<LandmarkId> a, b;
  Candidate candidate{into, from, TeamJoin::By::names, {}, {}, {}};
  for (const auto& [name, id] : ours) {
    const auto same = theirs.find(name);
    if (same == theirs.end()) continue;
    a.push_back(id);
    b.push_back(same->second);
    candidate.same.emplace_back(id, same->second);
  }
  if (a.size() < 2) return std::nullopt;
  const Fit fit = fit_of(points_of(state.components[into].filter, a), points_of(state.components[from].filter, b));
  candidate.T_into_from = fit.T;
  const double limit = core::chi2_quantile(options.probability, 2 * static_cast<int>(a.size()) - 3);
  if (!(fit.chi2 <= limit)) return std::nullopt;
  return candidate;
}

}  // namespace helixnav::team
