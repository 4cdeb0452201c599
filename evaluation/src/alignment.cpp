// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/alignment.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/rigid_fit.hpp"

namespace helixnav::evaluation {

namespace {

using Points = std::vector<Eigen::Vector2d>;

std::vector<double> residuals_m(const Points& a, const Points& b, const core::Pose2& T_a_b) {
  const Eigen::Matrix2d R = core::rotation(T_a_b.heading_rad);
  std::vector<double> residuals(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) residuals[i] = (a[i] - R * b[i] - T_a_b.position_m()).norm();
  return residuals;
}

core::Pose2 fit_used(const Points& a, const Points& b, const std::vector<bool>& used) {
  Points used_a;
  Points used_b;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!used[i]) continue;
    used_a.push_back(a[i]);
    used_b.push_back(b[i]);
  }
  return core::fit_rigidly(used_a, used_b);
}

RigidAlignment within(const Points& a, const Points& b, const core::Pose2& T_a_b, double limit_m) {
  RigidAlignment result{T_a_b, std::vector<bool>(a.size()), 0};
  const std::vector<double> residuals = residuals_m(a, b, T_a_b);
  for (std::size_t i = 0; i < a.size(); ++i) {
    result.used[i] = residuals[i] <= limit_m;
    result.used_count += result.used[i] ? 1 : 0;
  }
  return result;
}

// Alternates fit and selection until the selection no longer changes; it may cycle through a few, hence the bound.
RigidAlignment refine(const Points& a, const Points& b, const core::Pose2& begin, double limit_m) {
  RigidAlignment now = within(a, b, begin, limit_m);
  for (int iteration = 0; iteration < 100; ++iteration) {
    RigidAlignment next = within(a, b, fit_used(a, b, now.used), limit_m);
    const bool stays = next.used == now.used;
    now = std::move(next);
    if (stays) break;
  }
  return now;
}

core::Pose2 least_median(const Points& a, const Points& b) {
  constexpr int draws = 500;
  core::RandomStream random(0, "alignment");
  core::Pose2 best;
  double best_median_m = std::numeric_limits<double>::infinity();
  for (int draw = 0; draw < draws; ++draw) {
    const auto i = static_cast<std::size_t>(random.below(a.size()));
    const auto j = static_cast<std::size_t>(random.below(a.size()));
    if (i == j || a[i] == a[j] || b[i] == b[j]) continue;
    const core::Pose2 candidate = core::fit_rigidly({a[i], a[j]}, {b[i], b[j]});
    std::vector<double> residuals = residuals_m(a, b, candidate);
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    if (*middle < best_median_m) {
      best_median_m = *middle;
      best = candidate;
    }
  }
  return best;
}

}  // namespace

RigidAlignment align_rigidly(const Points& points_a, const Points& points_b, double limit_m) {
  if (points_a.size() != points_b.size()) {
    throw core::PreconditionError("align_rigidly: " + std::to_string(points_a.size()) + " and " +
                                  std::to_string(points_b.size()) + " points, expected as many of one as of the other");
  }
  if (points_a.empty()) return {};
  RigidAlignment from_all = refine(points_a, points_b, core::fit_rigidly(points_a, points_b), limit_m);
  RigidAlignment from_median = refine(points_a, points_b, least_median(points_a, points_b), limit_m);
  return from_median.used_count > from_all.used_count ? from_median : from_all;
}

}  // namespace helixnav::evaluation
