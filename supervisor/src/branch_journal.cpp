// SPDX-License-Identifier: BSD-3-Clause
#include "branch_journal.hpp"

#include "association_report.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::supervisor {

BranchJournal::BranchJournal(cekf::CompressedEkf& filter) : snapshot_(filter.snapshot()) {
  filter.keep_since(snapshot_.phase);
}

void BranchJournal::observe(const core::Scan& scan, const core::StepReport& report) {
  ScanEntry entry;
  entry.matches = matches(scan, report.associations);
  for (const core::AssociationReport& association : report.associations) {
    if (association.outcome != core::Outcome::augmented) continue;
    const core::Observation& seen = scan.observations[static_cast<std::size_t>(association.observation)];
    entry.births.push_back({association.landmark, {association.landmark, seen, scan.T_robot_sensor}});
    born_.insert(association.landmark);
  }
  cost_.nis += report.joint_nis;
  cost_.dof += report.joint_dof;
  entries_.emplace_back(std::move(entry));
}

cekf::UpdateResult BranchJournal::replay(cekf::CompressedEkf& filter,
                                         const std::map<core::LandmarkId, core::LandmarkId>& old_of) const {
  filter.restore(snapshot_);
  cekf::UpdateResult total;
  for (const Entry& entry : entries_) {
    if (const auto* odometry = std::get_if<core::Odometry>(&entry)) {
      filter.switch_region_if_due();
      filter.predict(*odometry);
    } else if (const auto* fix = std::get_if<core::AbsoluteFix>(&entry)) {
      filter.update_position(*fix);
    } else if (const auto* removal = std::get_if<Removal>(&entry)) {
      filter.remove(removal->id);
    } else {
      const cekf::UpdateResult one = repeat(filter, std::get<ScanEntry>(entry), old_of);
      total.nis += one.nis;
      total.dof += one.dof;
    }
  }
  return total;
}

cekf::UpdateResult BranchJournal::repeat(cekf::CompressedEkf& filter, const ScanEntry& entry,
                                         const std::map<core::LandmarkId, core::LandmarkId>& old_of) {
  bool sees_old = false;
  std::vector<cekf::Match> seen;
  const auto add = [&](cekf::Match match) {
    const auto found = old_of.find(match.landmark);
    if (found != old_of.end()) {
      match.landmark = found->second;
      sees_old = true;
    }
    seen.push_back(match);
  };
  for (const cekf::Match& match : entry.matches) add(match);
  for (const Birth& birth : entry.births) {
    if (old_of.count(birth.id) > 0) add(birth.sighting);
  }
  const cekf::UpdateResult result = sees_old ? filter.update_iterated(seen) : filter.update(seen);
  for (const Birth& birth : entry.births) {
    const core::LandmarkId id = filter.augment(birth.sighting.observation, birth.sighting.T_robot_sensor);
    if (id != birth.id) throw core::PreconditionError("branch journal: the filter was changed behind its back");
    if (old_of.count(id) > 0) filter.remove(id);  // born only so that those after it get the ids that they had
  }
  return result;
}

std::size_t BranchJournal::bytes() const {
  std::size_t bytes = snapshot_.bytes() + entries_.size() * sizeof(Entry);
  for (const Entry& entry : entries_) {
    if (const auto* scan = std::get_if<ScanEntry>(&entry)) {
      bytes += scan->matches.size() * sizeof(cekf::Match) + scan->births.size() * sizeof(Birth);
    }
  }
  return bytes;
}

}  // namespace helixnav::supervisor
