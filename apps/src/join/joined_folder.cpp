// SPDX-License-Identifier: BSD-3-Clause
#include "joined_folder.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <utility>

#include "drive/drive_again.hpp"
#include "drive/earlier_session.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/append_cells.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/runs/drive_digest.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_manifest.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "joined_page.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + '"';
}

std::string joins_table(const std::vector<std::string>& runs, const supervisor::JoinedSessions& joined) {
  std::string text =
      "run,component,verdict,x,y,heading,merged,landmarks,questions,pairs,evidence,lead,needed,cost,dof,limit\n";
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const supervisor::JoinedSession& session = joined.sessions[k];
    const core::PlacedDecision& decision = session.decision;
    const core::Pose2& T = session.T_component_session;
    text += quoted(runs[k]) + ',' + std::to_string(session.component + 1) + ',' + core::row_of(decision).verdict;
    files::append_cells(text, {T.x_m, T.y_m, T.heading_rad, static_cast<double>(decision.merged),
                               static_cast<double>(session.name_of.size()), static_cast<double>(decision.questions),
                               static_cast<double>(decision.pairs), decision.evidence, decision.lead, decision.needed,
                               decision.cost, static_cast<double>(decision.dof), decision.limit});
    text += '\n';
  }
  return text;
}

std::string numbers_of(const std::vector<std::size_t>& sessions) {
  std::string text;
  for (const std::size_t session : sessions) text += (text.empty() ? "" : " ") + std::to_string(session + 1);
  return text;
}

std::string changes_table(const std::vector<ChangedLandmark>& shared) {
  std::string text = "component,landmark,x,y,change,seen_in,missing_in,counterpart,missed_by_chance,perhaps_copy_of\n";
  for (const ChangedLandmark& landmark : shared) {
    text += std::to_string(landmark.component + 1) + ',' + std::to_string(landmark.id);
    files::append_cells(text, {landmark.point_m.x(), landmark.point_m.y()});
    text += std::string(",") + name_of(landmark.change()) + ',' + numbers_of(landmark.seen_in) + ',' +
            numbers_of(landmark.missing_in) + ',' +
            (landmark.counterpart == core::no_landmark ? "" : std::to_string(landmark.counterpart));
    const bool unknown = landmark.missing_in.empty() || std::isnan(landmark.missed_by_chance);
    if (unknown) {
      text += ',';
    } else {
      files::append_cells(text, {landmark.missed_by_chance});
    }
    const bool is_copy = landmark.perhaps_copy_of != core::no_landmark;
    text += ',' + (is_copy ? std::to_string(landmark.perhaps_copy_of) : "") + '\n';
  }
  return text;
}

/// The first component in the folder itself, the others below it.
std::string component_folder(const std::string& out, std::size_t component) {
  return component == 0 ? out : out + "/component_" + std::to_string(component + 1);
}

void write_components(const std::string& out, const std::vector<core::JointMap>& components,
                      const std::vector<LandmarkNames>& landmarks) {
  for (std::size_t k = 0; k < components.size(); ++k) {
    const std::string folder = component_folder(out, k);
    runs::make_run_folder(folder, runs::RunWriter::IfNotEmpty::overwrite);  // the user was asked
    runs::write_map(folder, components[k], k < landmarks.size() ? landmarks[k] : LandmarkNames());
  }
}

/// A map contained in a run, identified by its file's digest.
struct Held {
  std::string sha256, name;
  bool joined = false;  ///< by join, else the run continued in it
};

/// Whether the run searched for its place on the given map and never found it: its own map then contains nothing of that one.
bool stayed_apart(const std::string& folder) {
  const runs::Run run = runs::read_run(folder);
  return runs::began_off_earlier_map(run) && !runs::is_on_earlier_map(run);
}

bool is_map(const runs::InputFile& input) {
  const std::string file = fs::path(input.name).filename().string();
  return file == "map.bin" || file == "drive.bin";
}

/// The maps that a run has taken in.
std::vector<Held> held_in(const std::string& run) {
  std::vector<Held> held;
  if (fs::exists(fs::path(run) / "manifest.json")) {
    const std::vector<runs::InputFile> inputs = runs::read_manifest(run).inputs;
    const bool none = std::any_of(inputs.begin(), inputs.end(), is_map) && stayed_apart(run);
    for (const runs::InputFile& input : inputs) {
      if (is_map(input) && !none) held.push_back({input.sha256, input.name});
    }
  }
  const std::string table = run + "/" + runs::joined_from_file;
  if (!fs::exists(table)) return held;
  constexpr std::size_t digits = 64;
  std::istringstream rows(files::read_whole_file(table));
  std::string row;
  while (std::getline(rows, row)) {
    if (row.size() > digits && row[digits] == ',')
      held.push_back({row.substr(0, digits), row.substr(digits + 1), true});
  }
  return held;
}

struct Holding {
  std::vector<std::string> own;  ///< digests of its map.bin and drive.bin
  std::vector<Held> held;
};

Holding holding_of(const std::string& run) {
  Holding holding{{runs::sha256_of_file(joint_map_file_in(run))}, held_in(run)};
  const std::string drive = drive_file_in(run);
  if (fs::exists(drive)) holding.own.push_back(runs::sha256_of_file(drive));
  return holding;
}

void check_two(const std::string& a, const Holding& of_a, const std::string& b, const Holding& of_b) {
  if (of_a.own.front() == of_b.own.front()) throw core::InputError(a + ": the same map as " + b);
  for (const Held& held : of_a.held) {
    if (std::find(of_b.own.begin(), of_b.own.end(), held.sha256) == of_b.own.end()) continue;
    throw core::InputError(a + (held.joined ? ": was joined from the map of " : ": went on in the map of ") + b +
                           " and holds it already; leave that out");
  }
  for (const Held& held : of_a.held) {
    for (const Held& other : of_b.held) {
      if (held.sha256 != other.sha256) continue;
      throw core::InputError(a + " and " + b + ": both hold the map of " + held.name + "; leave one of them out");
    }
  }
}

/// What the map of a component is made of, with what those parts were made of.
std::string joined_from_table(const std::vector<std::string>& runs, const supervisor::JoinedSessions& joined,
                              std::size_t component) {
  std::string text = runs::joined_from_header;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (joined.sessions[k].component != component || !fs::exists(joint_map_file_in(runs[k]))) continue;
    const std::string& run = runs[k];
    const Holding holding = holding_of(run);
    for (const std::string& digest : holding.own) text += digest + ',' + quoted(run) + '\n';
    for (const Held& held : holding.held)
      text += held.sha256 + ',' + (held.joined ? held.name : quoted(held.name)) + '\n';
  }
  return text;
}

bool are_same(const core::JointMap& a, const core::JointMap& b) {
  return !a.joint.ids.empty() && a.joint.points_m == b.joint.points_m &&
         a.joint.pose.vector() == b.joint.pose.vector() && a.joint.covariance.rows() == b.joint.covariance.rows() &&
         a.joint.covariance == b.joint.covariance;
}

/// Both sorted.
bool have_drive_in_common(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::string> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return !common.empty();
}

}  // namespace

void check_independent(const std::vector<std::string>& runs) {
  std::vector<Holding> holdings;
  for (const std::string& run : runs) holdings.push_back(holding_of(run));
  for (std::size_t a = 0; a < runs.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      check_two(runs[a], holdings[a], runs[b], holdings[b]);
      check_two(runs[b], holdings[b], runs[a], holdings[a]);
    }
  }
}

void check_independent(const std::vector<core::JointMap>& maps, const std::vector<std::string>& names) {
  for (std::size_t a = 0; a < maps.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (are_same(maps[a], maps[b])) throw core::InputError(names[a] + ": the same map as " + names[b]);
      if (!have_drive_in_common(maps[a].drives, maps[b].drives)) continue;
      throw core::InputError(names[a] + " and " + names[b] +
                             ": both hold what one drive saw, which would count twice; leave one of them out");
    }
  }
}

void tell_drives(const std::vector<core::JointMap>& maps, supervisor::JoinedSessions& joined) {
  for (core::JointMap& component : joined.components) component.drives.clear();
  for (std::size_t k = 0; k < maps.size(); ++k) {
    std::vector<std::string>& drives = joined.components[joined.sessions[k].component].drives;
    drives = runs::united_drives(std::move(drives), maps[k].drives);
  }
}

void write_joined(const std::string& out, const std::vector<std::string>& names,
                  const supervisor::JoinedSessions& joined, const std::vector<ChangedLandmark>& shared,
                  const std::vector<LandmarkNames>& landmarks) {
  write_components(out, joined.components, landmarks);
  for (std::size_t k = 0; k < joined.components.size(); ++k) {
    files::write_whole_file(component_folder(out, k) + "/" + runs::joined_from_file,
                            joined_from_table(names, joined, k));
  }
  files::write_whole_file(out + "/joins.csv", joins_table(names, joined));
  files::write_whole_file(out + "/changes.csv", changes_table(shared));
  files::write_whole_file(out + "/report.html", joined_page(names, joined, shared));
}

}  // namespace helixnav::apps
