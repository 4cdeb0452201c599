// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "helixnav/cekf/reserved_matrix.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::cekf {

/// What a phase froze when it began, and, once closed, what it did to the passive part. A landmark that has ever been
/// passive has a slot s: rows 2s and 2s+1 below.
struct Phase {
  long number = 0;
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();            ///< of the vehicle then
  double start_heading_variance_rad2 = 0.0;                     ///< of the vehicle then
  int slots = 0;                                                ///< known when the phase began
  std::vector<std::pair<core::LandmarkId, int>> passive_slots;  ///< of the landmarks that were passive then, by name
  Eigen::VectorXd mean_m;                                       ///< 2·slots
  Eigen::MatrixXd own_covariance_m2 = Eigen::MatrixXd::Zero(0, 2);  ///< 2·slots × 2: the 2×2 diagonal blocks of P_bb0
  ReservedMatrix basis;                                             ///< E, 2·slots × q; activation appends columns
  std::vector<std::pair<std::pair<int, int>, core::LandmarkId>> by_cell;  ///< passive landmarks by cell, sorted
  std::vector<int> late_anchors;  ///< slots whose columns were appended, in order

  // Filled when the phase closes: P_bb += response·basisᵀ over `touched`, then the rows and columns of `written` are overwritten.
  std::vector<int> touched;  ///< weights that an update reached: all other columns of M are zero
  Eigen::MatrixXd response;  ///< those columns of E·M, 2·slots × |touched|
  std::vector<int> written;  ///< slots of the landmarks active at the end
  std::shared_ptr<const ReservedMatrix> end_columns;  ///< 2·slots_after × (3 + 2·|written|): with vehicle and `written`
  std::vector<int> dead;                              ///< slots free once the phase can no longer be undone
  std::vector<int> taken;                             ///< slots taken from the free list when the phase closed

  /// 2·slots_after × 2·|written|.
  auto written_covariance() const { return end_columns->view().rightCols(end_columns->cols() - 3); }
};

}  // namespace helixnav::cekf
