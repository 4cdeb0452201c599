// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "matrices/move_rows.hpp"
#include "region/before_switch.hpp"

namespace helixnav::cekf {
namespace {

std::vector<MovedRows> to_rows_of_landmarks(const std::vector<int>& slots) {
  std::vector<MovedRows> moves;
  moves.reserve(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    moves.push_back({2 * static_cast<Eigen::Index>(slots[i]), ActivePart::column(static_cast<int>(i))});
  }
  return moves;
}

}  // namespace

Eigen::Vector2i CompressedEkf::cell_of(const Eigen::Vector2d& point_m) const {
  // Beyond the range of int the cast gives anything; half of it leaves room for the neighbours of the last cell.
  constexpr double last = 1 << 30;
  return (point_m / options_.cell_side_m).array().floor().max(-last).min(last).cast<int>();
}

int CompressedEkf::most_active() const { return std::max(options_.max_active_landmarks, 2 * active_.last_seen); }

/// With all landmarks active, D coordinates, a phase has no weights, and an update of m rows costs m·D²; with n coordinates
/// active and w·n weights it costs m·(1 + w)²·n².
int CompressedEkf::most_when_whole() const { return (1 + weights_per_anchor()) * most_active(); }

bool CompressedEkf::is_whole_cheaper() const {
  const int few = most_when_whole() - most_when_whole() / 4;
  return mapped_count() <= few || active_.costs.is_whole_cheaper(3.0 + 2.0 * mapped_count());
}

bool CompressedEkf::is_whole() const { return phases_.back().passive_slots.empty(); }

bool CompressedEkf::is_region_due() const {
  const double side_m = options_.cell_side_m;
  const Eigen::Vector2d middle_m = side_m * (active_.cell.cast<double>() + Eigen::Vector2d::Constant(0.5));
  const double outside_m = (active_.pose.position_m() - middle_m).cwiseAbs().maxCoeff() - 0.5 * side_m;
  return outside_m > options_.hysteresis_m || active_count() > (is_whole() ? most_when_whole() : most_active());
}

/// If all are active and are to be so again, nothing is closed.
bool CompressedEkf::switch_region_if_due() {
  if (!is_region_due()) return false;
  const std::vector<core::LandmarkId> region = region_around_vehicle();
  if (is_whole() && static_cast<int>(region.size()) == mapped_count()) {
    active_.cell = cell_of(active_.pose.position_m());
    return false;
  }
  switch_region(region);
  return true;
}

void CompressedEkf::switch_region() { switch_region(region_around_vehicle()); }

void CompressedEkf::switch_region(const std::vector<core::LandmarkId>& active) {
  for (const core::LandmarkId id : active) place_of(id, "switch_region");
  std::vector<core::LandmarkId> wanted = active;
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  BeforeSwitch before{active_.slots, free_slots_, last_phase_, phases_.back().taken.size(), nullptr, {}, {}};
  const std::size_t phases = phases_.size();
  try {
    Phase next;
    next.start_m = active_.pose.position_m();
    next.start_heading_variance_rad2 = active_.P.view()(2, 2);
    const std::shared_ptr<const ReservedMatrix> columns = close_phase(next, before);
    open_phase(std::move(next), columns->view(), wanted);
  } catch (...) {
    if (phases_.size() > phases) phases_.pop_back();
    reopen_phase(before);
    throw;
  }
}

void CompressedEkf::reopen_phase(BeforeSwitch& before) {
  take_back_covariance(before);
  open_again(phases_.back());
  phases_.back().taken.resize(before.taken);
  active_.slots.swap(before.slots);
  free_slots_.swap(before.free_slots);
  last_phase_ = before.last_phase;
}

/// Landmarks of the vehicle's cell and its eight neighbours. When there are too many: the whole map if that costs less,
/// else the nearest, fewer than may be active, so that the next activation does not make another switch due.
std::vector<core::LandmarkId> CompressedEkf::region_around_vehicle() const {
  const Eigen::Vector2i cell = cell_of(active_.pose.position_m());
  const Phase& phase = phases_.back();
  const Eigen::VectorXd passive_m = phase.mean_m + phase.basis.view() * active_.theta;
  std::vector<std::pair<double, core::LandmarkId>> near;
  for (const auto& [id, place] : places_) {
    const bool is_active = place.where == Whereabouts::active;
    const Eigen::Vector2d mean_m =
        is_active ? active_.points_m[static_cast<std::size_t>(place.index)]
                  : Eigen::Vector2d(passive_m.segment<2>(2 * static_cast<Eigen::Index>(place.index)));
    if ((cell_of(mean_m) - cell).cwiseAbs().maxCoeff() > 1) continue;
    near.emplace_back((mean_m - active_.pose.position_m()).squaredNorm(), id);
  }
  const std::ptrdiff_t most = most_active();
  const std::ptrdiff_t kept = most - most / 4;
  if (static_cast<std::ptrdiff_t>(near.size()) > kept) {
    if (is_whole_cheaper()) return landmarks();
    std::nth_element(near.begin(), near.begin() + kept, near.end());
    near.resize(static_cast<std::size_t>(kept));
  }
  std::vector<core::LandmarkId> ids;
  for (const auto& [distance, id] : near) ids.push_back(id);
  return ids;
}

/// Begins a phase with these active landmarks. `columns` are the covariances of all slots with the active part so far.
/// If the closed phase is absorbed at once, everything that allocates comes first and nothing after it can fail; if it
/// is kept, nothing but the list of phases has changed until the end.
void CompressedEkf::open_phase(Phase&& next, const Eigen::Ref<const Eigen::MatrixXd>& columns,
                               const std::vector<core::LandmarkId>& active) {
  std::vector<int> slots;
  std::vector<int> entering;
  std::vector<Eigen::Index> entering_at;
  for (const core::LandmarkId id : active) {
    const Place& place = *find_place(id);
    const bool was_active = place.where == Whereabouts::active;
    if (!was_active) entering.push_back(place.index);
    if (!was_active) entering_at.push_back(ActivePart::column(static_cast<int>(slots.size())));
    slots.push_back(was_active ? active_.slots[static_cast<std::size_t>(place.index)] : place.index);
  }
  freeze_slots(next, active);
  ActivePart part = room_for(next, active, slots);
  const bool is_whole = next.passive_slots.empty();
  next.basis = ReservedMatrix(2 * next.slots, 0);
  if (!is_whole) next.basis.reserve(2 * next.slots, weights_per_anchor() * (part.dimension() + 16));
  std::vector<MovedRows> moves = to_rows_of_landmarks(slots);
  Eigen::VectorXd column(std::max<Eigen::Index>(2 * next.slots, part.dimension()));
  ReservedMatrix anchors;
  anchors.reserve(column.size(), part.dimension());
  anchors.resize(2 * next.slots, part.dimension());
  phases_.push_back(std::move(next));
  absorb_closed_phases(keep_since_);
  fill_start_columns(entering, phases_.size() - 1, entering_at, anchors.view());

  // Nothing below allocates or throws. Anchors: covariances of all slots with the vehicle and each active landmark.
  anchors.view().leftCols<3>() = columns.leftCols<3>();
  for (std::size_t i = 0; i < active.size(); ++i) {
    const Place& place = *find_place(active[i]);
    if (place.where != Whereabouts::active) continue;
    anchors.view().middleCols<2>(ActivePart::column(static_cast<int>(i))) =
        columns.middleCols<2>(ActivePart::column(place.index));
  }
  if (is_whole) {
    start_whole_covariance(moves, column, anchors, part);
  } else {
    start_covariance(anchors, part);
  }
  active_ = std::move(part);
  if (!is_whole) append_first_columns(phases_.back(), active_.slots, anchors.view());
  rebuild_places();
}

/// Slots of the landmarks that the phase leaves passive.
void CompressedEkf::freeze_slots(Phase& phase, const std::vector<core::LandmarkId>& active) const {
  std::vector<core::LandmarkId> left_out = active;
  std::sort(left_out.begin(), left_out.end());
  phase.passive_slots.clear();
  phase.by_cell.clear();
  for (const auto& [id, place] : places_) {
    if (std::binary_search(left_out.begin(), left_out.end(), id)) continue;
    const bool was_active = place.where == Whereabouts::active;
    const int slot = was_active ? active_.slots[static_cast<std::size_t>(place.index)] : place.index;
    const Eigen::Vector2i cell = cell_of(phase.mean_m.segment<2>(2 * slot));
    phase.passive_slots.emplace_back(id, slot);
    phase.by_cell.push_back({{cell.x(), cell.y()}, id});
  }
  std::sort(phase.by_cell.begin(), phase.by_cell.end());
}

/// The active part that the phase begins with, all but its covariance. If nothing is passive, there is nothing for the
/// weights to refer to.
ActivePart CompressedEkf::room_for(const Phase& phase, const std::vector<core::LandmarkId>& active,
                                   const std::vector<int>& slots) const {
  ActivePart part;
  part.pose = active_.pose;
  part.next_id = active_.next_id;
  part.last_seen = active_.last_seen;
  part.cell = cell_of(phase.start_m);
  part.costs = active_.costs;
  if (active_.weights() > 0) {
    const auto touched = static_cast<double>(phases_.back().touched.size());
    part.costs.note(active_.rows, active_.dimension(), active_.weights(), touched);
  }
  part.ids = active;
  part.slots = slots;
  for (const int slot : slots) part.points_m.push_back(phase.mean_m.segment<2>(2 * slot));
  const int n = part.dimension();
  part.A.resize(0, n);
  if (phase.passive_slots.empty()) return part;
  part.P.resize(n, n);
  part.theta = Eigen::VectorXd::Zero(weights_per_anchor() * n);
  std::vector<Eigen::Vector2d> offsets_m;
  for (const Eigen::Vector2d& point_m : part.points_m) offsets_m.push_back(point_m - phase.start_m);
  append_weights_for(offsets_m, true, part);
  return part;
}

void CompressedEkf::start_covariance(const ReservedMatrix& anchors, ActivePart& part) const {
  auto P = part.P.view();
  P.topLeftCorner<3, 3>() = active_.P.view().topLeftCorner<3, 3>();
  for (std::size_t i = 0; i < part.slots.size(); ++i) {
    P.middleRows<2>(ActivePart::column(static_cast<int>(i))) = anchors.view().middleRows<2>(2 * part.slots[i]);
  }
  P.triangularView<Eigen::StrictlyUpper>() = P.transpose();
}

/// The same where all landmarks are active: the anchors become the covariance, in their place.
void CompressedEkf::start_whole_covariance(const std::vector<MovedRows>& moves, Eigen::VectorXd& column,
                                           ReservedMatrix& anchors, ActivePart& part) const {
  const int n = part.dimension();
  anchors.resize(column.size(), n);
  move_rows(moves, column, anchors);
  anchors.resize(n, n);
  std::swap(part.P, anchors);
  auto P = part.P.view();
  P.topLeftCorner<3, 3>() = active_.P.view().topLeftCorner<3, 3>();
  P.triangularView<Eigen::StrictlyUpper>() = P.transpose();
}

}  // namespace helixnav::cekf
