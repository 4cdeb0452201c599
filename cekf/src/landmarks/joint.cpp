// SPDX-License-Identifier: BSD-3-Clause
// The joint estimate of the pose and of any landmarks.
#include <algorithm>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/add_outer.hpp"
#include "helixnav/core/mirror_lower.hpp"
#include "helixnav/core/packed_product.hpp"
#include "region/touched_weights.hpp"

namespace helixnav::cekf {
namespace {

constexpr std::size_t many = 128;  ///< passive landmarks that are read at once

ReservedMatrix zeros(Eigen::Index rows, Eigen::Index cols) {
  ReservedMatrix matrix;
  matrix.reserve(rows, cols);  // exactly: for a whole map's joint covariance there is no room to spare
  matrix.resize(rows, cols);
  return matrix;
}

/// sum += e·M·eᵀ for a symmetric M, the lower triangle. Weights that no update has reached are left out.
void add_both_sides(const Eigen::MatrixXd& e, const Eigen::MatrixXd& M, Eigen::MatrixXd& sum) {
  const std::vector<int> touched = columns_not_zero(M);
  if (touched.empty()) return;
  const Eigen::MatrixXd M_touched = M(touched, touched);
  const Eigen::Index n = e.rows();
  ReservedMatrix reached = zeros(n, M_touched.cols());  // by the weights
  core::add_product(reached.col(0), reached.stride(), core::Panels(e, touched, core::left_width),
                    core::Panels(M_touched, core::right_width));
  ReservedMatrix right = zeros(n, M_touched.cols());
  right.view() = e(Eigen::all, touched);
  constexpr Eigen::Index columns = 256;  // a multiple of eight
  for (Eigen::Index first = 0; first < n; first += columns) {
    ReservedMatrix part = zeros(n - first, std::min(columns, n - first));
    core::add_outer(part.col(0), part.stride(), part.padded_rows(), part.cols(), reached.col(0) + first,
                    reached.stride(), right.col(0) + first, right.stride(), M_touched.cols());
    sum.block(first, first, part.rows(), part.cols()) += part.view();
  }
}

/// The same for the rows of a few landmarks, by columns, no matrix formed; added to the lower triangle of `sum`.
void add_both_sides_of_few(const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& e,
                           const Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& M, Eigen::MatrixXd& sum) {
  Eigen::VectorXd reached(e.rows());
  for (Eigen::Index k = 0; k < M.cols(); ++k) {
    const Eigen::Index below = M.cols() - k - 1;
    const auto column = M.col(k).tail(below);
    for (Eigen::Index i = 0; i < e.rows(); ++i) reached[i] = e.row(i).tail(below).dot(column) + 0.5 * M(k, k) * e(i, k);
    for (Eigen::Index j = 0; j < e.rows(); ++j) {
      for (Eigen::Index i = j; i < e.rows(); ++i) sum(i, j) += reached[i] * e(j, k) + e(i, k) * reached[j];
    }
  }
}

/// sum += e·M·eᵀ, the first columns of it.
void add_between(const Eigen::MatrixXd& e, const core::Panels& M, ReservedMatrix& sum) {
  ReservedMatrix reached(sum.cols(), e.cols());  // by the weights
  const Eigen::MatrixXd first = e.topRows(sum.cols());
  core::add_product(reached.col(0), reached.stride(), core::Panels(first, core::left_width), M);
  core::add_product(sum.col(0), sum.stride(), core::Panels(e, core::left_width),
                    core::Panels(reached.view(), core::right_width));
}

}  // namespace

/// Covariances of many passive landmarks with one another, written where they belong: for a whole map there is no room for
/// a second matrix of its size. `rows` ascend.
void CompressedEkf::fill_own_of_many(const std::vector<int>& slots, const std::vector<int>& rows,
                                     const Eigen::MatrixXd& e, Eigen::MatrixXd& C) const {
  const Eigen::MatrixXd M = active_.M.view().selfadjointView<Eigen::Lower>();
  const std::vector<int> touched = columns_not_zero(M);
  const core::Panels weights(M(touched, touched), core::right_width);
  for (std::size_t first = 0; first < slots.size(); first += many) {
    const std::vector<int> below(slots.begin() + static_cast<std::ptrdiff_t>(first), slots.end());
    const std::size_t count = std::min(many, below.size());
    const std::vector<int> here(below.begin(), below.begin() + static_cast<std::ptrdiff_t>(count));
    ReservedMatrix own(2 * static_cast<Eigen::Index>(below.size()), 2 * static_cast<Eigen::Index>(count));
    own.view() = phase_start_blocks(below, here);
    for (Eigen::Index row = 0; row < own.cols(); row += 2) {
      const Eigen::Index slot = here[static_cast<std::size_t>(row / 2)];
      own.view().block<2, 2>(row, row) = phases_.back().own_covariance_m2.middleRows<2>(2 * slot);
    }
    if (!touched.empty()) add_between(e.bottomRows(own.rows())(Eigen::all, touched), weights, own);
    const int* const row = rows.data() + 2 * first;
    for (Eigen::Index j = 0; j < own.cols(); ++j) {
      for (Eigen::Index i = j; i < own.rows(); ++i) C(row[i], row[j]) = own.view()(i, j);
    }
  }
  core::mirror_lower(C);
}

core::JointGaussian CompressedEkf::joint(const std::vector<core::LandmarkId>& ids) const {
  core::JointGaussian result;
  result.pose = active_.pose;
  result.ids = ids;
  const Eigen::Index n = 3 + 2 * static_cast<Eigen::Index>(ids.size());
  result.covariance.resize(n, n);

  // Where each row of the result comes from: a column of the active part, or a passive slot.
  std::vector<int> active_rows = {0, 1, 2};
  std::vector<int> active_columns = {0, 1, 2};
  std::vector<int> passive_rows;
  std::vector<int> passive_slots;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Place& place = place_of(ids[i], "joint");
    const int row = ActivePart::column(static_cast<int>(i));
    if (place.where == Whereabouts::active) {
      const int column = ActivePart::column(place.index);
      active_rows.insert(active_rows.end(), {row, row + 1});
      active_columns.insert(active_columns.end(), {column, column + 1});
      result.points_m.push_back(active_.points_m[static_cast<std::size_t>(place.index)]);
    } else {
      passive_rows.insert(passive_rows.end(), {row, row + 1});
      passive_slots.push_back(place.index);
      result.points_m.push_back(passive_mean(place.index));
    }
  }
  auto& C = result.covariance;
  C(active_rows, active_rows) = active_.P.view()(active_columns, active_columns);
  if (passive_slots.empty()) return result;

  const Eigen::MatrixXd e = basis_rows(passive_slots);
  const Eigen::MatrixXd cross = e * active_.A.view()(Eigen::all, active_columns);
  C(passive_rows, active_rows) = cross;
  C(active_rows, passive_rows) = cross.transpose();
  if (passive_slots.size() > many) {
    fill_own_of_many(passive_slots, passive_rows, e, C);
    return result;
  }
  const Eigen::Index rows = e.rows();
  const bool has_pairs = passive_slots.size() > 1;  // a landmark's own block does not need any phase read again
  Eigen::MatrixXd own = has_pairs ? phase_start_blocks(passive_slots) : Eigen::MatrixXd::Zero(rows, rows);
  for (std::size_t i = 0; i < passive_slots.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    own.block<2, 2>(row, row) = phases_.back().own_covariance_m2.middleRows<2>(2 * passive_slots[i]);
  }
  constexpr std::size_t few = 4;  // M is then read once in place; forming and packing it costs more
  if (passive_slots.size() <= few) {
    add_both_sides_of_few(e, active_.M.view(), own);
  } else {
    add_both_sides(e, active_.M.view().selfadjointView<Eigen::Lower>(), own);
  }
  own.triangularView<Eigen::StrictlyUpper>() = own.transpose();
  C(passive_rows, passive_rows) = own;
  return result;
}

}  // namespace helixnav::cekf
