// SPDX-License-Identifier: BSD-3-Clause
// Reading the passive part: as it was when the phase began, and as it is now.
#include <algorithm>
#include <iterator>
#include <numeric>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/packed_product.hpp"

namespace helixnav::cekf {
namespace {

/// Position of the slot among those the phase wrote when it closed, or −1.
int written_index(const Phase& phase, int slot) {
  const auto found = std::find(phase.written.begin(), phase.written.end(), slot);
  return found == phase.written.end() ? -1 : static_cast<int>(found - phase.written.begin());
}

/// Rows 2s, 2s+1 of the slots, these columns; zero for slots that the phase does not know yet.
Eigen::MatrixXd rows_of(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& from,
                        const std::vector<int>& slots, const std::vector<int>& columns) {
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(slots.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t column = 0; column < columns.size(); ++column) {
    const auto source = from.col(columns[column]);
    for (std::size_t k = 0; k < slots.size(); ++k) {
      if (2 * slots[k] >= from.rows()) continue;
      rows.col(static_cast<Eigen::Index>(column)).segment<2>(2 * static_cast<Eigen::Index>(k)) =
          source.segment<2>(2 * slots[k]);
    }
  }
  return rows;
}

std::vector<int> all_columns(Eigen::Index count) {
  std::vector<int> columns(static_cast<std::size_t>(count));
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

/// Where the columns of a slot are among those asked for, and the first closed phase that they have to be carried over.
struct Carried {
  int slot;
  Eigen::Index column;
  std::size_t from;
};

/// What a closed phase adds to the columns of these slots.
ReservedMatrix change_of_columns(const Phase& phase, const core::Panels& response, const std::vector<int>& slots) {
  const Eigen::MatrixXd basis = rows_of(phase.basis.view(), slots, phase.touched);
  ReservedMatrix change(2 * phase.slots, basis.rows());
  if (response.depth() > 0) {
    core::add_product(change.col(0), change.stride(), response, core::Panels(basis, core::right_width));
    return change;
  }
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    for (Eigen::Index row = 0; row < basis.rows(); ++row) {
      change.view().col(row) += basis(row, k) * phase.response.col(k);
    }
  }
  return change;
}

/// Carries these columns of the map's covariance over a closed phase that did not write their slots; the phase is packed once for
/// all of them.
void replay_on_columns(const Phase& phase, const std::vector<Carried>& carried, Eigen::Ref<Eigen::MatrixXd> columns) {
  constexpr std::size_t few = 2;  // packing the phase for them costs more than going through it once
  constexpr std::size_t at_once = 128;
  core::Panels response(core::left_width);
  if (carried.size() > few) response.pack(phase.response);
  const auto written = phase.written_covariance();
  for (std::size_t first = 0; first < carried.size(); first += at_once) {
    std::vector<int> slots;
    for (std::size_t i = first; i < std::min(first + at_once, carried.size()); ++i) slots.push_back(carried[i].slot);
    const ReservedMatrix change = change_of_columns(phase, response, slots);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      auto own = columns.middleCols<2>(carried[first + i].column);
      own.topRows(2 * phase.slots) += change.view().middleCols<2>(2 * static_cast<Eigen::Index>(i));
      for (std::size_t k = 0; k < phase.written.size(); ++k) {
        own.middleRows<2>(2 * phase.written[k]) =
            written.block<2, 2>(2 * slots[i], 2 * static_cast<Eigen::Index>(k)).transpose();
      }
    }
  }
}

/// Blocks of rows and columns whose slots the phase wrote when it closed.
void overwrite_written(const Phase& phase, const std::vector<int>& rows, const std::vector<int>& columns,
                       Eigen::Ref<Eigen::MatrixXd> blocks) {
  const auto written = phase.written_covariance();
  const auto block = [&](std::size_t i, std::size_t j) {
    return blocks.block<2, 2>(2 * static_cast<Eigen::Index>(i), 2 * static_cast<Eigen::Index>(j));
  };
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const int w = written_index(phase, columns[j]);
    for (std::size_t i = 0; w >= 0 && i < rows.size(); ++i) {
      if (2 * rows[i] < written.rows()) block(i, j) = written.block<2, 2>(2 * rows[i], 2 * w);
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int w = written_index(phase, rows[i]);
    for (std::size_t j = 0; w >= 0 && j < columns.size(); ++j) {
      if (2 * columns[j] < written.rows()) block(i, j) = written.block<2, 2>(2 * columns[j], 2 * w).transpose();
    }
  }
}

/// Carries the covariance of the slots, its lower triangle, over a closed phase.
void replay_on_blocks(const Phase& phase, const std::vector<int>& slots, Eigen::MatrixXd& blocks) {
  if (!phase.touched.empty()) {  // a product of zero depth ends in a division by zero in Eigen
    const Eigen::MatrixXd response = rows_of(phase.response, slots, all_columns(phase.response.cols()));
    const Eigen::MatrixXd basis = rows_of(phase.basis.view(), slots, phase.touched);
    blocks.triangularView<Eigen::Lower>() += response * basis.transpose();
  }
  overwrite_written(phase, slots, slots, blocks);
}

/// Carries the covariance of some slots with others over a closed phase; some columns at a time, so that what they change by stays in
/// the second-level cache.
void replay_on_blocks(const Phase& phase, const std::vector<int>& rows, const std::vector<int>& columns,
                      Eigen::Ref<Eigen::MatrixXd> blocks) {
  constexpr Eigen::Index at_once = 32;
  if (!phase.touched.empty()) {
    const core::Panels response(rows_of(phase.response, rows, all_columns(phase.response.cols())), core::left_width);
    const Eigen::MatrixXd basis = rows_of(phase.basis.view(), columns, phase.touched);
    ReservedMatrix change(blocks.rows(), std::min(at_once, blocks.cols()));
    for (Eigen::Index first = 0; first < blocks.cols(); first += at_once) {
      const Eigen::Index count = std::min(at_once, blocks.cols() - first);
      change.set_zero();
      core::add_product(change.col(0), change.stride(), response,
                        core::Panels(basis.middleRows(first, count), core::right_width));
      blocks.middleCols(first, count) += change.view().leftCols(count);
    }
  }
  overwrite_written(phase, rows, columns, blocks);
}

}  // namespace

/// Covariance of all slots with the slots given, when the phase began.
Eigen::MatrixXd CompressedEkf::start_columns(const std::vector<int>& slots, std::size_t phase) const {
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(2 * phases_[phase].slots, 2 * static_cast<Eigen::Index>(slots.size()));
  std::vector<Eigen::Index> at;
  for (std::size_t k = 0; k < slots.size(); ++k) at.push_back(2 * static_cast<Eigen::Index>(k));
  fill_start_columns(slots, phase, at, columns);
  return columns;
}

/// The same into two columns each, from `at` on, that are zero. Allocates only where closed phases are kept.
void CompressedEkf::fill_start_columns(const std::vector<int>& slots, std::size_t phase,
                                       const std::vector<Eigen::Index>& at, Eigen::Ref<Eigen::MatrixXd> columns) const {
  std::vector<Carried> carried;
  for (std::size_t k = 0; k < slots.size(); ++k) {
    auto own = columns.middleCols<2>(at[k]);
    int w = -1;
    std::size_t p = phase;  // back to the last closed phase that wrote the slot
    while (w < 0 && p > 0) w = written_index(phases_[--p], slots[k]);
    if (w >= 0) {
      const auto written = phases_[p++].written_covariance();
      own.topRows(written.rows()) = written.middleCols<2>(2 * w);
    } else if (2 * slots[k] < absorbed_->rows()) {
      absorbed_->copy_columns(slots[k], own.topRows(absorbed_->rows()));
    }
    if (p < phase) carried.push_back({slots[k], at[k], p});
  }
  for (std::size_t p = 0; p < phase && !carried.empty(); ++p) {
    std::vector<Carried> here;
    std::copy_if(carried.begin(), carried.end(), std::back_inserter(here), [&](const Carried& one) {
      return one.from <= p && one.slot < phases_[p].slots;  // else it was written or born later
    });
    replay_on_columns(phases_[p], here, columns);
  }
}

Eigen::MatrixXd CompressedEkf::phase_start_blocks(const std::vector<int>& slots) const {
  const Eigen::Index n = 2 * static_cast<Eigen::Index>(slots.size());
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      if (2 * std::max(slots[i], slots[j]) >= absorbed_->rows()) continue;
      blocks.block<2, 2>(2 * static_cast<Eigen::Index>(i), 2 * static_cast<Eigen::Index>(j)) =
          absorbed_->block(slots[i], slots[j]);
    }
  }
  for (std::size_t p = 0; p + 1 < phases_.size(); ++p) replay_on_blocks(phases_[p], slots, blocks);
  return blocks;
}

Eigen::MatrixXd CompressedEkf::phase_start_blocks(const std::vector<int>& rows, const std::vector<int>& columns) const {
  const Eigen::Index most = absorbed_->rows();
  Eigen::MatrixXd blocks =
      Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(rows.size()), 2 * static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (2 * std::max(rows[i], columns[j]) >= most) continue;
      blocks.block<2, 2>(2 * static_cast<Eigen::Index>(i), 2 * static_cast<Eigen::Index>(j)) =
          absorbed_->block(rows[i], columns[j]);
    }
  }
  for (std::size_t p = 0; p + 1 < phases_.size(); ++p) replay_on_blocks(phases_[p], rows, columns, blocks);
  return blocks;
}

Eigen::MatrixXd CompressedEkf::basis_rows(const std::vector<int>& slots) const {
  const auto basis = phases_.back().basis.view();
  Eigen::MatrixXd rows(2 * static_cast<Eigen::Index>(slots.size()), basis.cols());
  for (std::size_t k = 0; k < slots.size(); ++k) {
    rows.middleRows<2>(2 * static_cast<Eigen::Index>(k)) = basis.middleRows<2>(2 * slots[k]);
  }
  return rows;
}

Eigen::Vector2d CompressedEkf::passive_mean(int slot) const {
  const Phase& phase = phases_.back();
  return phase.mean_m.segment<2>(2 * slot) + phase.basis.view().middleRows<2>(2 * slot) * active_.theta;
}

/// By how much these means have moved since the phase began; some columns at a time, as the basis lies in memory. The second
/// column of an anchor is the first turned by a right angle (append_columns) and need not be read.
std::vector<Eigen::Vector2d> CompressedEkf::moved_m(const std::vector<int>& slots) const {
  struct Column {
    const double* rows;
    double along, across;
  };
  std::vector<Column> columns;
  const int w = weights_per_anchor();
  columns.reserve(static_cast<std::size_t>(active_.theta.size()));
  for (Eigen::Index k = 0; k < active_.theta.size(); k += w) {
    const double across = w == 2 ? active_.theta(k + 1) : 0.0;
    if (active_.theta(k) == 0.0 && across == 0.0) continue;  // of an anchor that no update has reached
    columns.push_back({phases_.back().basis.col(k), active_.theta(k), across});
  }

  constexpr std::size_t at_once = 8;
  std::vector<Eigen::Vector2d> moved(slots.size(), Eigen::Vector2d::Zero());
  for (std::size_t first = 0; first < columns.size(); first += at_once) {
    const std::size_t end = std::min(columns.size(), first + at_once);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const auto row = 2 * static_cast<std::ptrdiff_t>(slots[i]);
      double x_m = moved[i].x();
      double y_m = moved[i].y();
      for (std::size_t k = first; k < end; ++k) {
        const Column& column = columns[k];
        const double* own = column.rows + row;
        x_m += column.along * own[0];
        y_m += column.along * own[1];
        x_m -= column.across * own[1];
        y_m += column.across * own[0];
      }
      moved[i] = {x_m, y_m};
    }
  }
  return moved;
}

}  // namespace helixnav::cekf
