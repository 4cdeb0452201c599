// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {
namespace {

using core::LandmarkId;

bool are_names(std::vector<LandmarkId> ids, LandmarkId next_name) {
  std::sort(ids.begin(), ids.end());
  const bool different = std::adjacent_find(ids.begin(), ids.end()) == ids.end();
  return different && next_name >= 0 && (ids.empty() || (ids.front() >= 0 && ids.back() < next_name));
}

/// All that can be said of a covariance in O(N²).
bool may_be_covariance(const Eigen::MatrixXd& P) {
  constexpr double rounding = 1e-9;
  if (!P.allFinite() || P.diagonal().minCoeff() < 0.0) return false;
  const double largest = P.cwiseAbs().maxCoeff();
  for (Eigen::Index j = 0; j < P.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) {
      const double most = std::sqrt(P(i, i) * P(j, j));
      if (std::abs(P(i, j) - P(j, i)) > rounding * largest) return false;
      if (std::abs(P(i, j)) > most + rounding * largest) return false;
    }
  }
  return true;
}

void check_start(const core::JointGaussian& start, LandmarkId next_name) {
  const auto n = static_cast<Eigen::Index>(3 + 2 * start.ids.size());
  const bool shaped = start.points_m.size() == start.ids.size() && start.covariance.rows() == n &&
                      start.covariance.cols() == n && are_names(start.ids, next_name);
  const auto is_finite = [](const Eigen::Vector2d& point_m) { return point_m.allFinite(); };
  if (!shaped || !std::all_of(start.points_m.begin(), start.points_m.end(), is_finite) ||
      !may_be_covariance(start.covariance)) {
    throw core::PreconditionError(
        "CompressedEkf: a joint start needs different ids below the next name, finite points and a covariance of pose "
        "and "
        "landmarks");
  }
}

core::PoseGaussian pose_of(const core::JointGaussian& start, LandmarkId next_name) {
  check_start(start, next_name);
  return {start.pose, start.covariance.topLeftCorner<3, 3>()};
}

}  // namespace

/// All landmarks are active in a first phase that leaves none passive, so that its weights mean nothing.
CompressedEkf::CompressedEkf(const core::JointGaussian& start, LandmarkId next_name, const FilterOptions& options)
    : CompressedEkf(pose_of(start, next_name), options) {
  const auto n = start.covariance.rows();
  active_.ids = start.ids;
  active_.points_m = start.points_m;
  active_.slots.assign(start.ids.size(), -1);
  active_.P.resize(n, n);
  active_.P.view() = 0.5 * (start.covariance + start.covariance.transpose());
  active_.A.resize(active_.weights(), n);
  active_.next_id = next_name;
  rebuild_places();
  switch_region();
}

}  // namespace helixnav::cekf
