// SPDX-License-Identifier: BSD-3-Clause
#include "identities.hpp"

#include <algorithm>

namespace helixnav::evaluation {

void Identities::add_sighting(core::LandmarkId id, core::Label label, double driven_m) {
  Record& record = records_[id];
  if (!record.fixed) ++record.votes[label];
  record.last_seen_m = driven_m;
}

void Identities::fix_unseen(double seen_before_m) {
  for (auto& [id, record] : records_) record.fixed = record.fixed || record.last_seen_m < seen_before_m;
}

void Identities::fix_if_unseen(core::LandmarkId id, double seen_before_m) {
  const auto found = records_.find(id);
  if (found != records_.end() && found->second.last_seen_m < seen_before_m) found->second.fixed = true;
}

core::Label Identities::majority(const Record& record) {
  const auto most = std::max_element(record.votes.begin(), record.votes.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == record.votes.end() ? core::no_label : most->first;
}

core::Label Identities::identity(core::LandmarkId id) const {
  const auto found = records_.find(id);
  return found == records_.end() ? core::no_label : majority(found->second);
}

bool Identities::is_old(core::LandmarkId id) const {
  const auto found = records_.find(id);
  if (found == records_.end() || !found->second.fixed) return false;
  const core::Label tree = majority(found->second);
  return tree != core::no_label && found->second.votes.at(tree) >= old_sightings_;
}

std::set<core::Label> Identities::old_trees() const {
  std::set<core::Label> trees;
  for (const auto& [id, record] : records_) {
    if (is_old(id)) trees.insert(majority(record));
  }
  return trees;
}

}  // namespace helixnav::evaluation
