// SPDX-License-Identifier: BSD-3-Clause
// Read-only views of the estimate for association, display and tests.
#include <algorithm>
#include <cmath>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/packed_product.hpp"
#include "region/touched_weights.hpp"

namespace helixnav::cekf {
namespace {

/// e·M·eᵀ for one landmark's rows e, from the lower triangle of M, by columns: O(q²), no matrix formed.
Eigen::Matrix2d both_sides(const Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>& e,
                           const Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& M) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (Eigen::Index k = 0; k < M.cols(); ++k) {
    const Eigen::Index below = M.cols() - k - 1;
    const auto column = M.col(k).tail(below);
    const Eigen::Vector2d reached(e.row(0).tail(below).dot(column), e.row(1).tail(below).dot(column));
    const Eigen::Matrix2d once = (reached + 0.5 * M(k, k) * e.col(k)) * e.col(k).transpose();
    sum += once + once.transpose();
  }
  return sum;
}

}  // namespace

core::PoseGaussian CompressedEkf::pose() const { return {active_.pose, active_.P.view().topLeftCorner<3, 3>()}; }

core::PointGaussian CompressedEkf::landmark(core::LandmarkId id) const {
  const Place& place = place_of(id, "landmark");
  if (place.where == Whereabouts::active) {
    const int column = ActivePart::column(place.index);
    return {active_.points_m[static_cast<std::size_t>(place.index)], active_.P.view().block<2, 2>(column, column)};
  }
  const Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> e =
      phases_.back().basis.view().middleRows<2>(2 * place.index);
  const Eigen::Matrix2d own =
      phases_.back().own_covariance_m2.middleRows<2>(2 * place.index) + both_sides(e, active_.M.view());
  return {passive_mean(place.index), 0.5 * (own + own.transpose())};
}

std::vector<core::PointGaussian> CompressedEkf::marginals(const std::vector<core::LandmarkId>& ids) const {
  std::vector<core::PointGaussian> points(ids.size());
  std::vector<int> slots;
  std::vector<std::size_t> where;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Place& place = place_of(ids[i], "marginals");
    if (place.where == Whereabouts::active) {
      points[i] = landmark(ids[i]);
    } else {
      slots.push_back(place.index);
      where.push_back(i);
    }
  }
  const std::vector<core::PointGaussian> passive = passive_marginals(slots);
  for (std::size_t k = 0; k < slots.size(); ++k) points[where[k]] = passive[k];
  return points;
}

/// Some at a time, so that the intermediate matrices are no larger than those of an update.
std::vector<core::PointGaussian> CompressedEkf::passive_marginals(const std::vector<int>& slots) const {
  constexpr std::size_t at_once = 128;
  std::vector<core::PointGaussian> points;
  if (slots.empty()) return points;
  const Phase& phase = phases_.back();
  const Eigen::MatrixXd M = active_.M.view().selfadjointView<Eigen::Lower>();
  const std::vector<int> touched = columns_not_zero(M);
  const core::Panels right(M(touched, touched), core::right_width);
  const std::vector<Eigen::Vector2d> moved = moved_m(slots);
  points.reserve(slots.size());
  while (points.size() < slots.size()) {
    const auto begin = slots.begin() + static_cast<std::ptrdiff_t>(points.size());
    const auto count = static_cast<std::ptrdiff_t>(std::min(at_once, slots.size() - points.size()));
    const Eigen::MatrixXd e = basis_rows({begin, begin + count})(Eigen::all, touched);
    ReservedMatrix reached(e.rows(), e.cols());  // by the weights
    if (!touched.empty()) core::add_product(reached.col(0), reached.stride(), core::Panels(e, core::left_width), right);
    for (Eigen::Index row = 0; row < e.rows(); row += 2) {
      const std::size_t k = points.size();
      Eigen::Matrix2d own = phase.own_covariance_m2.middleRows<2>(2 * slots[k]);
      if (!touched.empty()) {
        own += reached.view().middleRows<2>(row).lazyProduct(e.middleRows<2>(row).transpose());
      }
      points.push_back({phase.mean_m.segment<2>(2 * slots[k]) + moved[k], 0.5 * (own + own.transpose())});
    }
  }
  return points;
}

Eigen::Vector2d CompressedEkf::landmark_mean(core::LandmarkId id) const {
  const Place& place = place_of(id, "landmark_mean");
  return place.where == Whereabouts::active ? active_.points_m[static_cast<std::size_t>(place.index)]
                                            : passive_mean(place.index);
}

double CompressedEkf::landmark_sigma_bound_m(core::LandmarkId id) const {
  const Place& place = place_of(id, "landmark_sigma_bound_m");
  if (place.where == Whereabouts::active) {
    const int column = ActivePart::column(place.index);
    return std::sqrt(std::max(0.0, active_.P.view().block<2, 2>(column, column).trace()));
  }
  return sigma_bound_m(place.index,
                       (phases_.back().basis.view().middleRows<2>(2 * place.index) * active_.theta).norm());
}

/// For a passive landmark whose mean has moved by moved_m since the phase began.
double CompressedEkf::sigma_bound_m(int slot, double moved_m) const {
  const Phase& phase = phases_.back();
  const auto own = phase.own_covariance_m2.middleRows<2>(2 * slot);
  const double start_m = std::sqrt(std::max(0.0, own(0, 0) + own(1, 1)));
  if (options_.retraction == Retraction::standard) return start_m;
  constexpr double there_and_back = 2.0;  // the path of a mean over all updates is longer than what is left of it
  const double heading_rad = std::sqrt(std::max(phase.start_heading_variance_rad2, active_.P.view()(2, 2)));
  return start_m + there_and_back * moved_m * heading_rad;
}

Eigen::Matrix<double, 2, 3> CompressedEkf::covariance_with_pose(core::LandmarkId id) const {
  const Place& place = place_of(id, "covariance_with_pose");
  if (place.where == Whereabouts::active) return active_.P.view().block<2, 3>(ActivePart::column(place.index), 0);
  return phases_.back().basis.view().middleRows<2>(2 * place.index) * active_.A.view().leftCols<3>();
}

}  // namespace helixnav::cekf
