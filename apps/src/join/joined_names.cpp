// SPDX-License-Identifier: BSD-3-Clause
#include "joined_names.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <set>

#include "helixnav/runs/run_folder.hpp"

namespace helixnav::apps {
namespace {

using Called = std::map<core::LandmarkId, std::set<std::string>>;

/// What the runs of a component call its landmarks.
Called called_in(std::size_t component, const std::vector<LandmarkNames>& of_runs,
                 const supervisor::JoinedSessions& joined) {
  Called called;
  for (std::size_t k = 0; k < joined.sessions.size(); ++k) {
    const supervisor::JoinedSession& session = joined.sessions[k];
    if (session.component != component) continue;
    for (const auto& [id, name] : of_runs[k]) {
      const auto here = session.name_of.find(id);
      if (here != session.name_of.end()) called[here->second].insert(name);
    }
  }
  return called;
}

bool is_mature_on(const core::JointMap& map, core::LandmarkId id) {
  const auto at = std::lower_bound(map.joint.ids.begin(), map.joint.ids.end(), id);
  if (at == map.joint.ids.end() || *at != id) return false;
  return map.states[static_cast<std::size_t>(at - map.joint.ids.begin())] == core::LandmarkState::mature;
}

/// The only one, or the only one that is still there; no_landmark if that leaves several.
core::LandmarkId owner_of_name(const std::vector<core::LandmarkId>& ids, const core::JointMap& map) {
  if (ids.size() == 1) return ids.front();
  std::vector<core::LandmarkId> there;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(there),
               [&map](core::LandmarkId id) { return is_mature_on(map, id); });
  return there.size() == 1 ? there.front() : core::no_landmark;
}

std::string contradictions_text(const std::vector<std::string>& several_names,
                                const std::vector<std::string>& several_landmarks) {
  std::string text;
  if (!several_names.empty()) {
    text = std::to_string(several_names.size()) + " landmarks have several names (" + several_names.front() +
           (several_names.size() > 1 ? ", …)" : ")");
  }
  if (!several_landmarks.empty()) {
    text += (text.empty() ? "" : " and ") + std::to_string(several_landmarks.size()) + " names several landmarks ('" +
            several_landmarks.front() + (several_landmarks.size() > 1 ? "', …)" : "')");
  }
  return text;
}

LandmarkNames agreed_names(const Called& called, const core::JointMap& map, std::string& contradictions) {
  std::vector<std::string> several_names, several_landmarks;
  std::map<std::string, std::vector<core::LandmarkId>> having;
  for (const auto& [id, names] : called) {
    if (names.size() == 1) {
      having[*names.begin()].push_back(id);
    } else {
      several_names.push_back("'" + *names.begin() + "' is also '" + *names.rbegin() + "'");
    }
  }
  LandmarkNames agreed;
  for (const auto& [name, ids] : having) {
    const core::LandmarkId owner = owner_of_name(ids, map);
    if (owner == core::no_landmark) {
      several_landmarks.push_back(name);
    } else {
      agreed[owner] = name;
    }
  }
  contradictions = contradictions_text(several_names, several_landmarks);
  return agreed;
}

}  // namespace

LandmarkNames landmark_names_in(const std::string& folder) {
  const std::filesystem::path table = std::filesystem::path(folder) / "map.csv";
  return std::filesystem::exists(table) ? runs::read_landmark_names(table.string()) : LandmarkNames();
}

JoinedNames joined_names(const std::vector<LandmarkNames>& of_runs, const supervisor::JoinedSessions& joined) {
  JoinedNames result;
  for (std::size_t k = 0; k < joined.components.size(); ++k) {
    std::string contradictions;
    result.of_component.push_back(agreed_names(called_in(k, of_runs, joined), joined.components[k], contradictions));
    if (contradictions.empty()) continue;
    result.notes.push_back("component " + std::to_string(k + 1) + ": by where they stand, " + contradictions +
                           "; these are without a name on the joined map. Names are misread at times, or the runs do "
                           "not use the same ones");
  }
  return result;
}

}  // namespace helixnav::apps
