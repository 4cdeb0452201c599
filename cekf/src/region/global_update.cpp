// SPDX-License-Identifier: BSD-3-Clause
// The end of a phase: what its weights say is recorded, and applied to the passive covariance when nothing needs to be
// undone any more.
#include <algorithm>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/packed_product.hpp"
#include "matrices/make_room.hpp"
#include "region/before_switch.hpp"
#include "region/touched_weights.hpp"

namespace helixnav::cekf {
namespace {

/// Columns 2s, 2s+1 of left·rightᵀ in the rows 2s, 2s+1, for all slots.
void add_own_blocks(const Eigen::MatrixXd& left, const ReservedMatrix& right, const std::vector<int>& columns,
                    Eigen::MatrixXd& blocks) {
  for (Eigen::Index k = 0; k < left.cols(); ++k) {
    const auto r = right.view().col(columns[static_cast<std::size_t>(k)]);
    for (Eigen::Index i = 0; i + 1 < left.rows(); i += 2) {
      blocks.block<2, 2>(i, 0) += left.block<2, 1>(i, k) * r.segment<2>(i).transpose();
    }
  }
}

/// The columns named of E·M, where M is symmetric and zero outside the rows and columns named.
Eigen::MatrixXd product_with_symmetric(const ReservedMatrix& E, const Eigen::MatrixXd& M,
                                       const std::vector<int>& columns) {
  const Eigen::MatrixXd M_named = M(columns, columns);
  ReservedMatrix named(E.rows(), M_named.cols());
  core::add_product(named.col(0), named.stride(), core::Panels(E.view(), columns, core::left_width),
                    core::Panels(M_named, core::right_width));
  return named.view();
}

std::vector<MovedRows> to_rows_of_slots(const std::vector<int>& slots) {
  std::vector<MovedRows> moves;
  moves.reserve(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    moves.push_back({ActivePart::column(static_cast<int>(i)), 2 * static_cast<Eigen::Index>(slots[i])});
  }
  return moves;
}

}  // namespace

void CompressedEkf::global_update() {
  const std::vector<core::LandmarkId> same = active_.ids;
  switch_region(same);
}

/// Gives every active landmark a slot.
int CompressedEkf::assign_slots(Phase& phase) {
  int slots = phase.slots;
  for (int& slot : active_.slots) {
    if (slot >= 0) continue;
    if (free_slots_.empty()) {
      slot = slots++;
    } else {
      slot = free_slots_.back();
      free_slots_.pop_back();
      phase.taken.push_back(slot);
    }
  }
  return slots;
}

/// Covariance of all slots (rows) with the active part (columns), 2·slots × n.
ReservedMatrix CompressedEkf::end_columns(int slots) const {
  const int n = active_.dimension();
  const core::Panels basis(phases_.back().basis.view(), core::left_width);
  ReservedMatrix columns(2 * slots, n);
  const Eigen::MatrixXd weights = active_.A.view().transpose();
  core::add_product(columns.col(0), columns.stride(), basis, core::Panels(weights, core::right_width));
  const auto P = active_.P.view();
  for (int i = 0; i < active_count(); ++i) {
    columns.view().middleRows<2>(2 * active_.slots[static_cast<std::size_t>(i)]) =
        P.middleRows<2>(ActivePart::column(i));
  }
  return columns;
}

/// The same when nothing is passive: the filter already holds this, with its rows in another order, and it is large, so
/// it is not copied. The covariance of the vehicle alone stays behind.
std::shared_ptr<const ReservedMatrix> CompressedEkf::hand_over_covariance(int slots, BeforeSwitch& before) {
  const int n = active_.dimension();
  std::vector<MovedRows> moves = to_rows_of_slots(active_.slots);
  const Eigen::Index rows = std::max<Eigen::Index>(n, 2 * slots);
  Eigen::VectorXd column(rows);
  ReservedMatrix vehicle(3, 3);
  vehicle.view() = active_.P.view().topLeftCorner<3, 3>();
  const auto columns = std::make_shared<ReservedMatrix>();
  active_.P.reserve(rows, n);

  // Nothing below allocates or throws.
  std::swap(active_.P, vehicle);
  std::swap(*columns, vehicle);
  columns->resize(rows, n);
  move_rows(moves, column, *columns);
  columns->resize(2 * slots, n);
  before.columns = columns;
  before.column.swap(column);
  before.moves.swap(moves);
  return columns;
}

/// The covariance of the active part again. No allocation.
void CompressedEkf::take_back_covariance(BeforeSwitch& before) {
  if (!before.columns) return;
  ReservedMatrix& P = *before.columns;
  const int n = active_.dimension();
  for (MovedRows& one : before.moves) std::swap(one.from, one.to);
  P.resize(before.column.size(), n);
  move_rows(before.moves, before.column, P);
  P.resize(n, n);
  P.view().topRightCorner(3, n - 3) = P.view().bottomLeftCorner(n - 3, 3).transpose();
  P.view().topLeftCorner<3, 3>() = active_.P.view();
  std::swap(active_.P, P);
}

/// A landmark's own variance that has become negative or is not finite: nothing of such a phase may be recorded.
void CompressedEkf::check_own_covariances(const Phase& next) const {
  for (const auto& [id, place] : places_) {
    const bool is_active = place.where == Whereabouts::active;
    const int slot = is_active ? active_.slots[static_cast<std::size_t>(place.index)] : place.index;
    const auto own = next.own_covariance_m2.middleRows<2>(2 * static_cast<Eigen::Index>(slot));
    constexpr double rounding = 1e-18;
    if (own(0, 0) >= -rounding && own(1, 1) >= -rounding && own.allFinite()) continue;
    std::ostringstream problem;
    problem << "switch_region: after phase " << phases_.back().number << " landmark " << id << " would have variances "
            << own(0, 0) << " m2 and " << own(1, 1) << " m2";
    throw core::NumericalError(problem.str());
  }
}

/// Fills what only a closed phase has, and what the next one freezes.
std::shared_ptr<const ReservedMatrix> CompressedEkf::close_phase(Phase& next, BeforeSwitch& before) {
  Phase& phase = phases_.back();
  make_room(phase.taken, active_.slots.size());
  const int slots = assign_slots(phase);
  const auto columns =
      is_whole() ? hand_over_covariance(slots, before) : std::make_shared<const ReservedMatrix>(end_columns(slots));

  const Eigen::MatrixXd M = active_.M.view().selfadjointView<Eigen::Lower>();
  phase.touched = columns_not_zero(M);
  phase.response = product_with_symmetric(phase.basis, M, phase.touched);
  phase.written = active_.slots;
  phase.end_columns = columns;
  phase.dead = active_.dead_slots;
  if (phase.number >= keep_since_) phase.basis = ReservedMatrix(phase.basis);  // compact: a search may keep hundreds

  next.number = ++last_phase_;
  next.slots = slots;
  next.mean_m = Eigen::VectorXd::Zero(2 * slots);
  next.mean_m.head(2 * phase.slots) = phase.mean_m + phase.basis.view() * active_.theta;
  next.own_covariance_m2 = Eigen::MatrixXd::Zero(2 * slots, 2);
  next.own_covariance_m2.topRows(2 * phase.slots) = phase.own_covariance_m2;
  add_own_blocks(phase.response, phase.basis, phase.touched, next.own_covariance_m2);
  for (std::size_t i = 0; i < active_.slots.size(); ++i) {
    const int row = 2 * active_.slots[i];
    const int column = ActivePart::column(static_cast<int>(i));
    next.mean_m.segment<2>(row) = active_.points_m[i];
    next.own_covariance_m2.middleRows<2>(row) = columns->view().block<2, 2>(row, column);
  }
  check_own_covariances(next);
  return columns;
}

/// Closed phases before `until` become part of the passive covariance. Whatever allocates comes first; phases are packed
/// one after the other, because a search that ends may have kept hundreds.
void CompressedEkf::absorb_closed_phases(long until) {
  std::size_t count = 0;
  std::size_t dead = 0;
  core::Panels response(core::left_width);
  core::Panels basis(core::right_width);
  for (; count + 1 < phases_.size() && phases_[count].number < until; ++count) {
    const Phase& phase = phases_[count];
    response.reserve(phase.response.rows(), phase.response.cols());
    basis.reserve(phase.basis.rows(), phase.response.cols());
    dead += phase.dead.size();
  }
  if (count == 0) return;
  make_room(free_slots_, dead);
  const bool is_shared = absorbed_.use_count() > 1;
  if (is_shared) absorbed_ = std::make_shared<PassiveCovariance>(*absorbed_);
  absorbed_->grow(static_cast<int>(phases_[count - 1].end_columns->rows()));

  // Nothing below allocates or throws.
  for (; count > 0; --count) {
    const Phase& phase = phases_.front();
    response.pack(phase.response);
    basis.pack(phase.basis.view(), phase.touched);
    absorbed_->add_symmetric_product(response, basis);
    absorbed_->overwrite(phase.written, phase.written_covariance());
    free_slots_.insert(free_slots_.end(), phase.dead.begin(), phase.dead.end());
    phases_.erase(phases_.begin());
  }
}

void CompressedEkf::keep_since(long phase) {
  absorb_closed_phases(phase);
  keep_since_ = phase;
}

void CompressedEkf::keep_open_phase() noexcept { keep_since_ = std::min(keep_since_, phases_.back().number); }

}  // namespace helixnav::cekf
