// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <sstream>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {

std::size_t Snapshot::bytes() const {
  const std::size_t lists = active.points_m.size() * sizeof(Eigen::Vector2d) +
                            (active.ids.size() + active.slots.size() + active.left_passive.size() +
                             active.dead_slots.size() + active.late_anchors.size()) *
                                sizeof(int);
  return sizeof(Snapshot) + active.P.bytes() + active.A.bytes() + active.M.bytes() +
         static_cast<std::size_t>(active.theta.size()) * sizeof(double) + lists;
}

Snapshot CompressedEkf::snapshot() const { return {phases_.back().number, active_}; }

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
  while (phases_.back().number != snapshot.phase) {
    return_slots(phases_.back());
    phases_.pop_back();
  }
  Phase& phase = phases_.back();
  return_slots(phase);
  phase.touched.clear();
  phase.response.resize(0, 0);
  phase.written.clear();
  phase.written_covariance.resize(0, 0);
  phase.dead.clear();
  active_ = snapshot.active;
  align_late_anchors(phase);
  rebuild_places();
}

void CompressedEkf::name_from(core::LandmarkId id) {
  active_.next_id = std::max(active_.next_id, id);
  places_.resize(static_cast<std::size_t>(active_.next_id));
}

std::size_t CompressedEkf::kept_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t p = 0; p + 1 < phases_.size(); ++p) {
    const Phase& phase = phases_[p];
    bytes += phase.basis.bytes() + phase.slot_of_id.size() * sizeof(int) +
             static_cast<std::size_t>(phase.response.size() + phase.written_covariance.size() + phase.mean_m.size() +
                                      phase.own_covariance_m2.size()) *
                 sizeof(double);
  }
  return bytes;
}

void CompressedEkf::return_slots(Phase& phase) {
  free_slots_.insert(free_slots_.end(), phase.taken.rbegin(), phase.taken.rend());
  phase.taken.clear();
}

/// The basis keeps the anchors that phase and snapshot have in common and gets those that are missing.
void CompressedEkf::align_late_anchors(Phase& phase) {
  const std::vector<int>& wanted = active_.late_anchors;
  std::vector<int>& have = phase.late_anchors;
  const auto [have_end, wanted_end] = std::mismatch(have.begin(), have.end(), wanted.begin(), wanted.end());
  const Eigen::Index surplus = 2 * weights_per_anchor() * (have.end() - have_end);
  const std::vector<int> missing(wanted_end, wanted.end());
  have.erase(have_end, have.end());
  phase.basis.resize(phase.basis.rows(), phase.basis.cols() - surplus);
  for (const int slot : missing) {
    append_columns(phase, phase_start_columns({slot}));
    have.push_back(slot);
  }
}

}  // namespace helixnav::cekf
