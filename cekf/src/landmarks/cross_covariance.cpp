// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/packed_product.hpp"
#include "region/touched_weights.hpp"

namespace helixnav::cekf {
namespace {

ReservedMatrix product(const core::Panels& left, const core::Panels& right) {
  ReservedMatrix result(left.rows(), right.rows());
  core::add_product(result.col(0), result.stride(), left, right);
  return result;
}

/// e·M·fᵀ for a symmetric M given by its lower triangle. Weights that no update has reached are left out.
void add_both_sides(const Eigen::MatrixXd& e, const Eigen::MatrixXd& M, const Eigen::MatrixXd& f,
                    Eigen::MatrixXd& sum) {
  const std::vector<int> touched = columns_not_zero(M);
  if (touched.empty()) return;
  const Eigen::MatrixXd M_touched = M(touched, touched);
  const ReservedMatrix reached =
      product(core::Panels(e, touched, core::left_width), core::Panels(M_touched, core::right_width));
  sum += product(core::Panels(reached.view(), core::left_width), core::Panels(f, touched, core::right_width)).view();
}

}  // namespace

/// Where the rows of these landmarks are: columns of the active part, or passive slots.
struct CompressedEkf::Parts {
  std::vector<int> active_rows, active_columns;
  std::vector<int> passive_rows, slots;
};

CompressedEkf::Parts CompressedEkf::parts_of(const std::vector<core::LandmarkId>& ids, const char* verb) const {
  Parts parts;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Place& place = place_of(ids[i], verb);
    const int row = 2 * static_cast<int>(i);
    if (place.where == Whereabouts::active) {
      const int column = ActivePart::column(place.index);
      parts.active_rows.insert(parts.active_rows.end(), {row, row + 1});
      parts.active_columns.insert(parts.active_columns.end(), {column, column + 1});
    } else {
      parts.passive_rows.insert(parts.passive_rows.end(), {row, row + 1});
      parts.slots.push_back(place.index);
    }
  }
  return parts;
}

Eigen::MatrixXd CompressedEkf::cross_covariance(const std::vector<core::LandmarkId>& rows,
                                                const std::vector<core::LandmarkId>& columns) const {
  const Parts one = parts_of(rows, "cross_covariance");
  const Parts other = parts_of(columns, "cross_covariance");
  Eigen::MatrixXd C(2 * static_cast<Eigen::Index>(rows.size()), 2 * static_cast<Eigen::Index>(columns.size()));
  C(one.active_rows, other.active_rows) = active_.P.view()(one.active_columns, other.active_columns);
  const Eigen::MatrixXd e = basis_rows(one.slots);
  const Eigen::MatrixXd f = basis_rows(other.slots);
  C(one.passive_rows, other.active_rows) = e * active_.A.view()(Eigen::all, other.active_columns);
  C(one.active_rows, other.passive_rows) = (f * active_.A.view()(Eigen::all, one.active_columns)).transpose();
  if (one.slots.empty() || other.slots.empty()) return C;
  Eigen::MatrixXd both = phase_start_blocks(one.slots, other.slots);
  add_both_sides(e, active_.M.view().selfadjointView<Eigen::Lower>(), f, both);
  C(one.passive_rows, other.passive_rows) = both;
  return C;
}

}  // namespace helixnav::cekf
