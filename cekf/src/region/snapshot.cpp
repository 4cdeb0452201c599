// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <sstream>
#include <utility>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"
#include "matrices/make_room.hpp"

namespace helixnav::cekf {

std::size_t Snapshot::bytes() const {
  const std::size_t lists = active.points_m.size() * sizeof(Eigen::Vector2d) +
                            (active.ids.size() + active.slots.size() + active.left_passive.size() +
                             active.dead_slots.size() + active.late_anchors.size()) *
                                sizeof(int);
  return sizeof(Snapshot) + P.bytes() + active.A.bytes() + M.bytes() +
         static_cast<std::size_t>(active.theta.size()) * sizeof(double) + lists;
}

Snapshot CompressedEkf::snapshot() const {
  return {phases_.back().number, active_.without_symmetric(), PackedTriangle(active_.P), PackedTriangle(active_.M)};
}

bool CompressedEkf::can_restore(const Snapshot& snapshot) const {
  return std::any_of(phases_.begin(), phases_.end(),
                     [&](const Phase& phase) { return phase.number == snapshot.phase; });
}

void CompressedEkf::restore(const Snapshot& snapshot) {
  if (!can_restore(snapshot)) {
    std::ostringstream problem;
    problem << "restore: the snapshot belongs to phase " << snapshot.phase << ", out of reach; kept are phases "
            << phases_.front().number << " to " << phases_.back().number << " (see keep_since)";
    throw core::PreconditionError(problem.str());
  }
  std::size_t at = 0;
  while (phases_[at].number != snapshot.phase) ++at;
  ActivePart active = snapshot.active;
  active.P = snapshot.P.unpacked();
  active.M = snapshot.M.unpacked();
  const std::vector<int>& have = phases_[at].late_anchors;
  const auto common = static_cast<std::size_t>(
      std::mismatch(have.begin(), have.end(), active.late_anchors.begin(), active.late_anchors.end()).first -
      have.begin());
  std::vector<int> missing_slots(active.late_anchors.begin() + static_cast<std::ptrdiff_t>(common),
                                 active.late_anchors.end());
  Eigen::MatrixXd missing = start_columns(missing_slots, at);
  std::vector<int> late_anchors = active.late_anchors;
  std::size_t taken = 0;
  for (std::size_t p = at; p < phases_.size(); ++p) taken += phases_[p].taken.size();
  make_room(free_slots_, taken);
  places_.reserve(phases_[at].passive_slots.size() + active.ids.size());
  phases_[at].basis.make_room(phases_[at].basis.rows(), active.weights());

  // Nothing below allocates or throws.
  while (phases_.size() > at + 1) {
    return_slots(phases_.back());
    phases_.pop_back();
  }
  Phase& phase = phases_.back();
  return_slots(phase);
  open_again(phase);
  active_ = std::move(active);
  phase.basis.resize(phase.basis.rows(), active_.weights() - weights_per_anchor() * missing.cols());
  append_late_columns(phase, missing_slots, missing);
  phase.late_anchors.swap(late_anchors);
  rebuild_places();
}

/// What only a closed phase has.
void CompressedEkf::open_again(Phase& phase) {
  phase.touched.clear();
  phase.response.resize(0, 0);
  phase.written.clear();
  phase.end_columns.reset();
  phase.dead.clear();
}

void CompressedEkf::name_from(core::LandmarkId id) { active_.next_id = std::max(active_.next_id, id); }

std::size_t CompressedEkf::kept_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t p = 0; p + 1 < phases_.size(); ++p) {
    const Phase& phase = phases_[p];
    bytes += phase.basis.bytes() + phase.end_columns->bytes() +
             phase.passive_slots.size() * sizeof(phase.passive_slots[0]) +
             static_cast<std::size_t>(phase.response.size() + phase.mean_m.size() + phase.own_covariance_m2.size()) *
                 sizeof(double);
  }
  return bytes;
}

void CompressedEkf::return_slots(Phase& phase) {
  free_slots_.insert(free_slots_.end(), phase.taken.rbegin(), phase.taken.rend());
  phase.taken.clear();
}

}  // namespace helixnav::cekf
