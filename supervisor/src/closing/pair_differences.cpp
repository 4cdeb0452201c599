// SPDX-License-Identifier: BSD-3-Clause
#include "closing/pair_differences.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>

namespace helixnav::supervisor {

PairDifferences pair_differences(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, const core::Pose2& T,
                                 double sigma_m) {
  using Index = Eigen::Index;
  std::vector<core::LandmarkId> ids;
  for (const auto& [kept, removed] : pairs) ids.insert(ids.end(), {kept, removed});
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const core::JointGaussian joint = filter.joint(ids);
  const auto index_of = [&](core::LandmarkId id) { return std::lower_bound(ids.begin(), ids.end(), id) - ids.begin(); };
  const auto row_of = [&](core::LandmarkId id) { return 3 + 2 * static_cast<Index>(index_of(id)); };
  const auto mean_of = [&](core::LandmarkId id) { return joint.points_m[static_cast<std::size_t>(index_of(id))]; };
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(T.heading_rad).toRotationMatrix();
  const auto n = 2 * static_cast<Index>(pairs.size());
  PairDifferences result{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
  Eigen::MatrixXd PHt(joint.covariance.rows(), n);
  for (Index k = 0; k < n; k += 2) {
    const auto& [kept, removed] = pairs[static_cast<std::size_t>(k / 2)];
    PHt.middleCols<2>(k) = joint.covariance.middleCols<2>(row_of(kept)) -
                           joint.covariance.middleCols<2>(row_of(removed)) * turn.transpose();
    result.nu_m.segment<2>(k) = core::transform(T, mean_of(removed)) - mean_of(kept);
  }
  for (Index k = 0; k < n; k += 2) {
    const auto& [kept, removed] = pairs[static_cast<std::size_t>(k / 2)];
    result.S_m2.middleRows<2>(k) = PHt.middleRows<2>(row_of(kept)) - turn * PHt.middleRows<2>(row_of(removed));
  }
  result.S_m2.diagonal().array() += sigma_m * sigma_m;
  return result;
}

}  // namespace helixnav::supervisor
