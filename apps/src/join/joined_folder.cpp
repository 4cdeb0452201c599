// SPDX-License-Identifier: BSD-3-Clause
#include "joined_folder.hpp"

#include <cstddef>
#include <filesystem>
#include <system_error>

#include "drive/drive_again.hpp"
#include "drive/earlier_session.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/append_cells.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_manifest.hpp"
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
  std::string text = "component,landmark,x,y,change,seen_in,missing_in,counterpart\n";
  for (const ChangedLandmark& landmark : shared) {
    text += std::to_string(landmark.component + 1) + ',' + std::to_string(landmark.id);
    files::append_cells(text, {landmark.point_m.x(), landmark.point_m.y()});
    text += std::string(",") + name_of(landmark.change()) + ',' + numbers_of(landmark.seen_in) + ',' +
            numbers_of(landmark.missing_in) + ',' +
            (landmark.counterpart == core::no_landmark ? "" : std::to_string(landmark.counterpart)) + '\n';
  }
  return text;
}

/// The first component in the folder itself, the others below it.
void write_components(const std::string& out, const std::vector<core::JointMap>& components) {
  for (std::size_t k = 0; k < components.size(); ++k) {
    const std::string folder = k == 0 ? out : out + "/component_" + std::to_string(k + 1);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw core::InputError(folder + ": cannot make the folder: " + error.message());
    runs::write_map(folder, components[k]);
  }
}

}  // namespace

void check_independent(const std::vector<std::string>& runs) {
  std::vector<std::string> digests, drives;
  for (const std::string& run : runs) {
    const std::string drive = drive_file_in(run);
    digests.push_back(runs::sha256_of_file(joint_map_file_in(run)));
    drives.push_back(fs::exists(drive) ? runs::sha256_of_file(drive) : std::string());
  }
  for (std::size_t a = 0; a < runs.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (digests[a] == digests[b]) throw core::InputError(runs[a] + ": the same map as " + runs[b]);
    }
    if (!fs::exists(fs::path(runs[a]) / "manifest.json")) continue;
    for (const runs::InputFile& input : runs::read_manifest(runs[a]).inputs) {
      for (std::size_t b = 0; b < runs.size(); ++b) {
        if (input.sha256.empty() || (input.sha256 != digests[b] && input.sha256 != drives[b])) continue;
        throw core::InputError(runs[a] + ": went on in the map of " + runs[b] +
                               " and holds it already; leave that out");
      }
    }
  }
}

void write_joined(const std::string& out, const std::vector<std::string>& names,
                  const supervisor::JoinedSessions& joined, const std::vector<ChangedLandmark>& shared) {
  write_components(out, joined.components);
  files::write_whole_file(out + "/joins.csv", joins_table(names, joined));
  files::write_whole_file(out + "/changes.csv", changes_table(shared));
  files::write_whole_file(out + "/report.html", joined_page(names, joined, shared));
}

}  // namespace helixnav::apps
