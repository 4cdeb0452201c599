// SPDX-License-Identifier: BSD-3-Clause
#include "common_names.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"

namespace helixnav::team {
namespace {

using core::LandmarkId;

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

/// The rigid motion of weighted least squares.
core::Pose2 rigid_fit(const Points& a, const Points& b, const std::vector<double>& weights) {
  Eigen::Vector2d mean_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_b = Eigen::Vector2d::Zero();
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  for (std::size_t i = 0; i < a.at_m.size(); ++i) {
    mean_a += weights[i] / sum * a.at_m[i];
    mean_b += weights[i] / sum * b.at_m[i];
  }
  double dot = 0.0;
  double cross = 0.0;
  for (std::size_t i = 0; i < a.at_m.size(); ++i) {
    const Eigen::Vector2d da = a.at_m[i] - mean_a;
    const Eigen::Vector2d db = b.at_m[i] - mean_b;
    dot += weights[i] * db.dot(da);
    cross += weights[i] * (db.x() * da.y() - db.y() * da.x());
  }
  const double heading_rad = std::atan2(cross, dot);
  const Eigen::Vector2d at_m = mean_a - core::rotation(heading_rad) * mean_b;
  return {at_m.x(), at_m.y(), heading_rad};
}

/// The rigid motion of least distances, which a few points far off hardly affect; closer than a pair is known it is least squares.
core::Pose2 robust_fit(const Points& a, const Points& b) {
  constexpr int iterations = 30;
  std::vector<double> weights(a.at_m.size(), 1.0);
  core::Pose2 T = rigid_fit(a, b, weights);
  for (int k = 0; k < iterations; ++k) {
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(2 * i);
      const double sigma_m =
          std::sqrt(a.covariance.block<2, 2>(row, row).trace() + b.covariance.block<2, 2>(row, row).trace());
      weights[i] = 1.0 / std::max(sigma_m, (a.at_m[i] - core::transform(T, b.at_m[i])).norm());
    }
    T = rigid_fit(a, b, weights);
  }
  return T;
}

struct Fit {
  core::PoseGaussian T;
  double chi2 = 0.0;
  std::vector<double> saved;  ///< [point] by how much χ² falls without it, in the linear model
};

/// By how much χ² falls without each point, of its inverse covariance after the fit.
std::vector<double> saved_without(const Eigen::MatrixXd& after_fit, const Eigen::VectorXd& nu) {
  std::vector<double> saved;
  const Eigen::VectorXd pull = after_fit * nu;
  for (Eigen::Index i = 0; i < nu.size(); i += 2) {
    saved.push_back(pull.segment<2>(i).dot(after_fit.block<2, 2>(i, i).ldlt().solve(pull.segment<2>(i))));
  }
  return saved;
}

/// min νᵀS⁻¹ν over T, ν = a − T∘b, S = P_a + R P_b Rᵀ.
Fit fit_of(const Points& a, const Points& b, const core::Pose2& begin) {
  Fit fit;
  fit.T.mean = begin;
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
    if (k + 1 < iterations) continue;
    const Eigen::MatrixXd inverse = S.solve(Eigen::MatrixXd::Identity(n, n));
    fit.saved = saved_without(inverse - W * fit.T.covariance * W.transpose(), nu);
  }
  return fit;
}

/// How much a name counts: by the sightings of the map that knows it less.
int weight_of(const std::pair<LandmarkId, LandmarkId>& pair, const JoinOptions& options, const State& state) {
  const auto observations = [&](LandmarkId id) { return state.observations[static_cast<std::size_t>(id)]; };
  return std::min({observations(pair.first), observations(pair.second), options.mature_observations});
}

/// Both in one list.
std::pair<std::vector<LandmarkId>, std::vector<LandmarkId>> sides_of(const SamePairs& pairs) {
  std::pair<std::vector<LandmarkId>, std::vector<LandmarkId>> sides;
  for (const auto& [a, b] : pairs) {
    sides.first.push_back(a);
    sides.second.push_back(b);
  }
  return sides;
}

}  // namespace

NamesFit fit_names(std::size_t into, std::size_t from, const SamePairs& pairs, const JoinOptions& options,
                   const State& state) {
  constexpr int kept_for_one_left_out = 3;
  constexpr double far_off = 100.0;
  bool is_far_off = false;
  NamesFit result;
  result.kept = pairs;
  int kept = 0, left_out = 0;
  for (const auto& pair : pairs) kept += weight_of(pair, options, state);
  while (result.kept.size() >= 2) {
    const auto [ours, theirs] = sides_of(result.kept);
    const Points a = points_of(state.components[into].filter, ours);
    const Points b = points_of(state.components[from].filter, theirs);
    const core::Pose2 begin =
        result.left_out.empty() ? rigid_fit(a, b, std::vector<double>(ours.size(), 1.0)) : robust_fit(a, b);
    const Fit fit = fit_of(a, b, begin);
    result.T_into_from = fit.T;
    const double limit = core::chi2_quantile(options.probability, 2 * static_cast<int>(ours.size()) - 3);
    result.agree = fit.chi2 <= limit;
    if (result.left_out.empty()) is_far_off = fit.chi2 > far_off * limit;
    if (result.agree || !(fit.chi2 >= 0.0)) break;
    const auto worst = result.kept.begin() + (std::max_element(fit.saved.begin(), fit.saved.end()) - fit.saved.begin());
    const int weight = weight_of(*worst, options, state);
    kept -= weight;
    left_out += weight;
    if (kept_for_one_left_out * left_out > kept) break;
    result.left_out.push_back(*worst);
    result.kept.erase(worst);
  }
  result.hopeless = is_far_off && !result.agree;
  return result;
}

}  // namespace helixnav::team
