// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "helixnav/cekf/compressed_ekf.hpp"

namespace helixnav::cekf {

Eigen::Vector2i CompressedEkf::cell_of(const Eigen::Vector2d& point_m) const {
  return (point_m / options_.cell_side_m).array().floor().cast<int>();
}

bool CompressedEkf::switch_region_if_due() {
  const double side_m = options_.cell_side_m;
  const Eigen::Vector2d middle_m = side_m * (phases_.back().cell.cast<double>() + Eigen::Vector2d::Constant(0.5));
  const double outside_m = (active_.pose.position_m() - middle_m).cwiseAbs().maxCoeff() - 0.5 * side_m;
  const bool crowded = active_count() > options_.max_active_landmarks;
  if (outside_m <= options_.hysteresis_m && !crowded) return false;
  switch_region();
  return true;
}

void CompressedEkf::switch_region() { switch_region(region_around_vehicle()); }

void CompressedEkf::switch_region(const std::vector<core::LandmarkId>& active) {
  for (const core::LandmarkId id : active) place_of(id, "switch_region");
  std::vector<core::LandmarkId> wanted = active;
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  Phase next;
  next.cell = cell_of(active_.pose.position_m());
  const Eigen::MatrixXd columns = close_phase(next);
  open_phase(std::move(next), columns, wanted);
}

/// Landmarks of the vehicle's cell and its eight neighbours; when they are too many the nearest, and fewer than may be
/// active, so that the next activation does not make another switch due.
std::vector<core::LandmarkId> CompressedEkf::region_around_vehicle() const {
  const Eigen::Vector2i cell = cell_of(active_.pose.position_m());
  const Phase& phase = phases_.back();
  const Eigen::VectorXd passive_m = phase.mean_m + phase.basis.view() * active_.theta;
  std::vector<std::pair<double, core::LandmarkId>> near;
  for (const core::LandmarkId id : landmarks()) {
    const Place& place = places_[static_cast<std::size_t>(id)];
    const bool is_active = place.where == Whereabouts::active;
    const Eigen::Vector2d mean_m =
        is_active ? active_.points_m[static_cast<std::size_t>(place.index)]
                  : Eigen::Vector2d(passive_m.segment<2>(2 * static_cast<Eigen::Index>(place.index)));
    if ((cell_of(mean_m) - cell).cwiseAbs().maxCoeff() > 1) continue;
    near.emplace_back((mean_m - active_.pose.position_m()).squaredNorm(), id);
  }
  const std::ptrdiff_t most = options_.max_active_landmarks;
  const std::ptrdiff_t kept = most - most / 4;
  if (static_cast<std::ptrdiff_t>(near.size()) > kept) {
    std::nth_element(near.begin(), near.begin() + kept, near.end());
    near.resize(static_cast<std::size_t>(kept));
  }
  std::vector<core::LandmarkId> ids;
  for (const auto& [distance, id] : near) ids.push_back(id);
  return ids;
}

/// Begins a phase with these active landmarks. `columns` are the covariances of all slots with the active part so far.
void CompressedEkf::open_phase(Phase&& next, const Eigen::MatrixXd& columns,
                               const std::vector<core::LandmarkId>& active) {
  phases_.push_back(std::move(next));
  absorb_closed_phases();
  Phase& phase = phases_.back();

  std::vector<int> entering;
  for (const core::LandmarkId id : active) {
    const Place& place = places_[static_cast<std::size_t>(id)];
    if (place.where == Whereabouts::passive) entering.push_back(place.index);
  }
  const Eigen::MatrixXd entering_columns = phase_start_columns(entering);

  // Anchors of the phase: covariances of all slots with the vehicle and with each active landmark.
  const Eigen::Index n = 3 + 2 * static_cast<Eigen::Index>(active.size());
  Eigen::MatrixXd anchors(2 * phase.slots, n);
  anchors.leftCols<3>() = columns.leftCols<3>();
  std::vector<int> slots;
  Eigen::Index entered = 0;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const Place& place = places_[static_cast<std::size_t>(active[i])];
    auto own = anchors.middleCols<2>(ActivePart::column(static_cast<int>(i)));
    if (place.where == Whereabouts::active) {
      own = columns.middleCols<2>(ActivePart::column(place.index));
      slots.push_back(active_.slots[static_cast<std::size_t>(place.index)]);
    } else {
      own = entering_columns.middleCols<2>(2 * entered++);
      slots.push_back(place.index);
    }
  }
  freeze_slots(phase, active);
  start_active_part(phase, anchors, active, slots);
  phase.basis = ReservedMatrix(2 * phase.slots, 0);
  phase.basis.reserve(2 * phase.slots, weights_per_anchor() * (n + 16));
  phase.late_anchors.clear();
  append_columns(phase, anchors);
  rebuild_places();
}

/// Slots of the landmarks that the phase leaves passive.
void CompressedEkf::freeze_slots(Phase& phase, const std::vector<core::LandmarkId>& active) const {
  phase.slot_of_id.assign(places_.size(), -1);
  for (std::size_t id = 0; id < places_.size(); ++id) {
    const Place& place = places_[id];
    if (place.where == Whereabouts::passive) phase.slot_of_id[id] = place.index;
    if (place.where == Whereabouts::active) phase.slot_of_id[id] = active_.slots[static_cast<std::size_t>(place.index)];
  }
  for (const core::LandmarkId id : active) phase.slot_of_id[static_cast<std::size_t>(id)] = -1;
  phase.by_cell.clear();
  for (std::size_t id = 0; id < places_.size(); ++id) {
    const int slot = phase.slot_of_id[id];
    if (slot < 0) continue;
    const Eigen::Vector2i cell = cell_of(phase.mean_m.segment<2>(2 * slot));
    phase.by_cell.push_back({{cell.x(), cell.y()}, static_cast<core::LandmarkId>(id)});
  }
  std::sort(phase.by_cell.begin(), phase.by_cell.end());
}

void CompressedEkf::start_active_part(const Phase& phase, const Eigen::MatrixXd& anchors,
                                      const std::vector<core::LandmarkId>& active, const std::vector<int>& slots) {
  const int n = static_cast<int>(anchors.cols());
  const Eigen::Matrix3d P_vv = active_.P.view().topLeftCorner<3, 3>();
  active_.P.resize(0, 0);
  active_.P.resize(n, n);
  auto P = active_.P.view();
  P.topLeftCorner<3, 3>() = P_vv;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    P.middleRows<2>(ActivePart::column(static_cast<int>(i))) = anchors.middleRows<2>(2 * slots[i]);
  }
  P.triangularView<Eigen::StrictlyUpper>() = P.transpose();
  active_.ids = active;
  active_.slots = slots;
  active_.points_m.clear();
  for (const int slot : slots) active_.points_m.push_back(phase.mean_m.segment<2>(2 * slot));
  active_.left_passive.clear();
  active_.dead_slots.clear();
  active_.late_anchors.clear();
  active_.A.resize(0, 0);
  active_.M.resize(0, 0);
  active_.theta.resize(0);
  append_weights_for(0);
}

}  // namespace helixnav::cekf
