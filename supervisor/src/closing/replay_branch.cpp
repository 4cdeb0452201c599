// SPDX-License-Identifier: BSD-3-Clause
#include "closing/replay_branch.hpp"

#include <variant>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "slip/update_after_slip.hpp"

namespace helixnav::supervisor {
namespace {

using OldOf = std::map<core::LandmarkId, core::LandmarkId>;

/// The observations of the scan that began landmarks at the time.
template <class Visit>
void for_each_birth(const Tape::Scan& scan, const Visit& visit) {
  for (const core::AssociationReport& association : scan.fate) {
    if (association.outcome != core::Outcome::augmented) continue;
    visit(association.landmark, scan.scan.observations[static_cast<std::size_t>(association.observation)]);
  }
}

cekf::UpdateResult update_again(cekf::CompressedEkf& filter, const Tape::Scan& scan, const OldOf& old_of) {
  bool sees_old = false;
  std::vector<cekf::Match> seen;
  for (cekf::Match match : used_observations(scan)) {
    const auto found = old_of.find(match.landmark);
    if (found == old_of.end() && !filter.contains(match.landmark)) continue;  // begins it again below
    if (found != old_of.end()) {
      match.landmark = found->second;
      sees_old = true;
    }
    seen.push_back(match);
  }
  if (sees_old) return filter.update_iterated(seen);
  return scan.slipped ? update_after_slip(filter, seen) : filter.update(seen);
}

void augment_again(cekf::CompressedEkf& filter, const Tape::Scan& scan, const OldOf& old_of) {
  for_each_birth(scan, [&](core::LandmarkId born, const core::Observation& observation) {
    const core::LandmarkId id = filter.augment(observation, scan.scan.T_robot_sensor);
    if (id != born) throw core::PreconditionError("replay_branch: the filter was changed behind the tape's back");
    if (old_of.count(id) > 0) filter.remove(id);  // born only so that those after it get the ids they had
  });
}

}  // namespace

std::set<core::LandmarkId> born_in(const BranchRecord& branch) {
  std::set<core::LandmarkId> born;
  branch.tape.read_from(branch.trigger.position, [&](const Tape::Entry& entry) {
    if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      for_each_birth(*scan, [&](core::LandmarkId id, const core::Observation&) { born.insert(id); });
    }
  });
  return born;
}

cekf::UpdateResult replay_branch(cekf::CompressedEkf& filter, const BranchRecord& branch, const OldOf& old_of) {
  filter.restore(branch.trigger.filter);
  cekf::UpdateResult total;
  branch.tape.read_from(branch.trigger.position, [&](const Tape::Entry& entry) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) {
      filter.switch_region_if_due();
      filter.predict(motion->odometry);
    } else if (const auto* slip = std::get_if<Tape::Slip>(&entry)) {
      filter.predict(slip->motion);
    } else if (const auto* fix = std::get_if<Tape::Fix>(&entry)) {
      if (fix->accepted) filter.update_position(fix->used.fix);
    } else if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      const cekf::UpdateResult one = update_again(filter, *scan, old_of);
      total.nis += one.nis;
      total.dof += one.dof;
      augment_again(filter, *scan, old_of);
      for (const core::LandmarkId id : scan->died) filter.remove(id);
    }
  });
  return total;
}

}  // namespace helixnav::supervisor
