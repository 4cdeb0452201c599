// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"

namespace helixnav::cekf {
namespace {

/// Rows of a landmark, as columns: e·θ, by which its mean has moved in this phase, and e·A, its covariance with the pose.
using Reached = Eigen::Matrix<double, 4, 2>;

/// Column after column, as the basis lies in memory; the second of an anchor's two is the first turned by a right angle.
void reach(const Phase& phase, const Eigen::Matrix<double, 4, Eigen::Dynamic>& by_column, int per_anchor,
           const std::vector<int>& slots, std::vector<Reached>& reached) {
  for (Eigen::Index k = 0; k < by_column.cols(); k += per_anchor) {
    const Eigen::Vector4d along = by_column.col(k);
    Eigen::Vector4d across = Eigen::Vector4d::Zero();
    if (per_anchor == 2) across = by_column.col(k + 1);
    if (along.isZero(0.0) && across.isZero(0.0)) continue;  // of an anchor that no update has reached
    const double* column = phase.basis.col(k);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const double* own = column + 2 * static_cast<Eigen::Index>(slots[i]);
      reached[i].col(0) += own[0] * along;
      reached[i].col(1) += own[1] * along;
      reached[i].col(0) -= own[1] * across;
      reached[i].col(1) += own[0] * across;
    }
  }
}

}  // namespace

std::vector<Outlook> CompressedEkf::outlooks(const std::vector<core::LandmarkId>& ids) const {
  std::vector<Outlook> result(ids.size());
  std::vector<int> slots;
  std::vector<std::size_t> where;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Place& place = place_of(ids[i], "outlooks");
    if (place.where == Whereabouts::active) {
      result[i] = {landmark_mean(ids[i]), landmark_sigma_bound_m(ids[i]), covariance_with_pose(ids[i])};
    } else {
      slots.push_back(place.index);
      where.push_back(i);
    }
  }
  if (slots.empty()) return result;

  const Phase& phase = phases_.back();
  Eigen::Matrix<double, 4, Eigen::Dynamic> by_column(4, phase.basis.cols());
  by_column.row(0) = active_.theta.transpose();
  by_column.bottomRows<3>() = active_.A.view().leftCols<3>().transpose();
  std::vector<Reached> reached(slots.size(), Reached::Zero());
  reach(phase, by_column, weights_per_anchor(), slots, reached);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Eigen::Vector2d moved_m = reached[i].row(0).transpose();
    result[where[i]] = {phase.mean_m.segment<2>(2 * static_cast<Eigen::Index>(slots[i])) + moved_m,
                        sigma_bound_m(slots[i], moved_m.norm()), reached[i].bottomRows<3>().transpose()};
  }
  return result;
}

}  // namespace helixnav::cekf
