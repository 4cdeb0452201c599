// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/run_options.hpp"
#include "drive/earlier_session.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_manifest.hpp"
#include "session_changes.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

struct JoinJob {
  std::vector<std::string> runs;
  RunOptions folder;
};

/// Joined maps count what they know once: no session may be in the list twice, or within another one.
void check_independent(const std::vector<std::string>& runs) {
  std::vector<std::string> digests;
  for (const std::string& run : runs) digests.push_back(runs::sha256_of_file(joint_map_file_in(run)));
  for (std::size_t a = 0; a < runs.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (digests[a] == digests[b]) throw core::InputError(runs[a] + ": the same map as " + runs[b]);
    }
    if (!fs::exists(fs::path(runs[a]) / "manifest.json")) continue;
    for (const runs::InputFile& input : runs::read_manifest(runs[a]).inputs) {
      for (std::size_t b = 0; b < runs.size(); ++b) {
        if (input.sha256 != digests[b]) continue;
        throw core::InputError(runs[a] + ": went on in the map of " + runs[b] +
                               " and holds it already; leave that out");
      }
    }
  }
}

std::vector<core::JointMap> read_maps(const std::vector<std::string>& runs) {
  std::vector<core::JointMap> maps;
  for (const std::string& run : runs) maps.push_back(read_joint_map_in(run));
  return maps;
}

void append(std::string& text, std::initializer_list<double> numbers) {
  for (const double number : numbers) {
    text += ',';
    files::append_number(text, number);
  }
}

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
    append(text, {T.x_m, T.y_m, T.heading_rad, static_cast<double>(decision.merged),
                  static_cast<double>(session.name_of.size()), static_cast<double>(decision.questions),
                  static_cast<double>(decision.pairs), decision.evidence, decision.lead, decision.needed, decision.cost,
                  static_cast<double>(decision.dof), decision.limit});
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
  std::string text = "component,landmark,x,y,change,seen_in,missing_in\n";
  for (const ChangedLandmark& landmark : shared) {
    text += std::to_string(landmark.component + 1) + ',' + std::to_string(landmark.id);
    append(text, {landmark.point_m.x(), landmark.point_m.y()});
    text += std::string(",") + name_of(landmark.change()) + ',' + numbers_of(landmark.seen_in) + ',' +
            numbers_of(landmark.missing_in) + '\n';
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

void say_changes(const std::vector<ChangedLandmark>& shared) {
  std::map<Change, int> counts;
  for (const ChangedLandmark& landmark : shared) ++counts[landmark.change()];
  std::printf("on ground that several looked at: %d landmarks kept, %d gone, %d new, %d both\n", counts[Change::kept],
              counts[Change::gone], counts[Change::appeared], counts[Change::both]);
}

void say(const JoinJob& job, const supervisor::JoinedSessions& joined, const std::vector<ChangedLandmark>& shared) {
  for (std::size_t k = 0; k < job.runs.size(); ++k) {
    const supervisor::JoinedSession& session = joined.sessions[k];
    const core::Pose2& T = session.T_component_session;
    std::printf("%s: ", job.runs[k].c_str());
    if (session.decision.verdict == core::PlacedDecision::Verdict::accepted) {
      std::printf("in component %zu at %.2f m, %.2f m, %.2f°: %d landmarks merged, %.1f nats ahead (%.1f needed)\n",
                  session.component + 1, T.x_m, T.y_m, T.heading_rad * 180.0 / core::pi, session.decision.merged,
                  session.decision.lead, session.decision.needed);
    } else {
      std::printf("frame of component %zu, %zu landmarks", session.component + 1, session.name_of.size());
      const bool was_tried = session.decision.questions > 0;
      std::printf(was_tried ? "; on what came before it: %s\n" : "\n", core::row_of(session.decision).verdict.c_str());
    }
  }
  say_changes(shared);
  for (std::size_t k = 0; k < joined.components.size(); ++k) {
    std::printf("component %zu: %zu landmarks, %s\n", k + 1, joined.components[k].joint.ids.size(),
                k == 0 ? job.folder.out.c_str() : (job.folder.out + "/component_" + std::to_string(k + 1)).c_str());
  }
}

void join(CLI::App& command, const JoinJob& job) {
  prepare_run(command, job.folder);
  const std::vector<core::JointMap> maps = read_maps(job.runs);
  check_independent(job.runs);
  const supervisor::JoinedSessions joined = supervisor::join_sessions(maps);
  const std::vector<ChangedLandmark> shared = shared_landmarks(maps, joined);
  write_components(job.folder.out, joined.components);
  files::write_whole_file(job.folder.out + "/joins.csv", joins_table(job.runs, joined));
  files::write_whole_file(job.folder.out + "/changes.csv", changes_table(shared));
  if (!job.folder.quiet) say(job, joined, shared);
}

}  // namespace

void add_join_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("join", "Make one map of several runs that began anywhere");
  const auto job = std::make_shared<JoinJob>();
  command->add_option("RUN", job->runs, "Run folders with a map.bin, oldest first")->required()->expected(2, 1000);
  add_folder_options(*command, job->folder);
  command->get_option("--out")->required();
  command->footer(
      "No start is given: each map is found on the others by its landmarks, or stays a component of its own. --out "
      "gets\n"
      "map.csv and map.bin (replay --map goes on in them), joins.csv (how each run was placed, and why not) and\n"
      "changes.csv (what is new or gone where several runs looked). To take a run out again, join the others.\n\n"
      "Example:\n"
      "  helixnav join runs/monday runs/tuesday runs/robot_2 --out runs/week\n");
  command->callback([job, command] { join(*command, *job); });
}

}  // namespace helixnav::apps
