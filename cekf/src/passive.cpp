// SPDX-License-Identifier: BSD-3-Clause
// Reading the passive part: as it was when the phase began, and as it is now.
#include <algorithm>

#include "add_outer.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"

namespace helixnav::cekf {
namespace {

/// Position of the slot among those the phase wrote when it closed, or −1.
int written_index(const Phase& phase, int slot) {
  const auto found = std::find(phase.written.begin(), phase.written.end(), slot);
  return found == phase.written.end() ? -1 : static_cast<int>(found - phase.written.begin());
}

/// Carries columns 2s, 2s+1 of the map's covariance over a closed phase.
void replay_on_columns(const Phase& phase, int slot, Eigen::Ref<Eigen::MatrixXd> columns) {
  const int w = written_index(phase, slot);
  if (w >= 0) {
    columns.topRows(phase.written_covariance.rows()) = phase.written_covariance.middleCols<2>(2 * w);
    return;
  }
  if (slot >= phase.slots) return;  // born later
  const Eigen::MatrixXd c = phase.basis.view().middleRows<2>(2 * slot);
  columns.topRows(2 * phase.slots).noalias() += phase.response * c.transpose();
  for (std::size_t k = 0; k < phase.written.size(); ++k) {
    columns.middleRows<2>(2 * phase.written[k]) =
        phase.written_covariance.block<2, 2>(2 * slot, 2 * static_cast<Eigen::Index>(k)).transpose();
  }
}

}  // namespace

Eigen::MatrixXd CompressedEkf::phase_start_columns(const std::vector<int>& slots) const {
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(2 * phases_.back().slots, 2 * static_cast<Eigen::Index>(slots.size()));
  for (std::size_t k = 0; k < slots.size(); ++k) {
    auto own = columns.middleCols<2>(2 * static_cast<Eigen::Index>(k));
    if (2 * slots[k] < absorbed_.rows()) absorbed_.copy_columns(slots[k], own.topRows(absorbed_.rows()));
    for (std::size_t p = 0; p + 1 < phases_.size(); ++p) replay_on_columns(phases_[p], slots[k], own);
  }
  return columns;
}

Eigen::Matrix2d CompressedEkf::phase_start_block(int slot_i, int slot_j) const {
  Eigen::Matrix2d block = Eigen::Matrix2d::Zero();
  if (2 * std::max(slot_i, slot_j) < absorbed_.rows()) block = absorbed_.block(slot_i, slot_j);
  for (std::size_t p = 0; p + 1 < phases_.size(); ++p) {
    const Phase& phase = phases_[p];
    const int wi = written_index(phase, slot_i);
    const int wj = written_index(phase, slot_j);
    if (wj >= 0 && 2 * slot_i < phase.written_covariance.rows()) {
      block = phase.written_covariance.block<2, 2>(2 * slot_i, 2 * wj);
    } else if (wi >= 0 && 2 * slot_j < phase.written_covariance.rows()) {
      block = phase.written_covariance.block<2, 2>(2 * slot_j, 2 * wi).transpose();
    } else if (std::max(slot_i, slot_j) < phase.slots) {
      block += phase.response.middleRows<2>(2 * slot_i) * phase.basis.view().middleRows<2>(2 * slot_j).transpose();
    }
  }
  return block;
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

}  // namespace helixnav::cekf
