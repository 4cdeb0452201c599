// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/run_options.hpp"
#include "drive/earlier_session.hpp"
#include "drive/kept_inputs.hpp"
#include "helixnav/core/decision_row.hpp"
#include "joined_folder.hpp"
#include "joined_names.hpp"
#include "joined_warnings.hpp"
#include "run_views.hpp"
#include "session_changes.hpp"

namespace helixnav::apps {
namespace {

struct JoinJob {
  std::vector<std::string> runs;
  RunOptions folder;
};

std::vector<core::JointMap> read_maps(const std::vector<std::string>& runs) {
  std::vector<core::JointMap> maps;
  for (const std::string& run : runs) maps.push_back(read_dense_map_in(run, "join"));
  return maps;
}

std::vector<std::optional<SessionViews>> read_views(const std::vector<std::string>& runs,
                                                    const std::vector<core::JointMap>& maps) {
  std::vector<std::optional<SessionViews>> views;
  for (std::size_t k = 0; k < runs.size(); ++k) views.push_back(views_in(runs[k], maps[k]));
  return views;
}

std::vector<LandmarkNames> read_names(const std::vector<std::string>& runs) {
  std::vector<LandmarkNames> names;
  for (const std::string& run : runs) names.push_back(landmark_names_in(run));
  return names;
}

/// It then cannot be detected that a run is of the same drive as another, which would be counted twice.
void note_unknown_drives(const std::vector<std::string>& runs, const std::vector<core::JointMap>& maps) {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (!maps[k].drives.empty()) continue;
    std::fprintf(stderr,
                 "helixnav: note: %s: no drives.csv says which drive its map is from; whether another run is of the "
                 "same drive, and counts twice, is unknown\n",
                 runs[k].c_str());
  }
}

void say_changes(const std::vector<ChangedLandmark>& shared) {
  std::map<Change, int> counts;
  for (const ChangedLandmark& landmark : shared) ++counts[landmark.change()];
  std::printf("on ground that several looked at: %d landmarks kept, %d gone, %d new, %d moved, %d both\n",
              counts[Change::kept], counts[Change::gone], counts[Change::appeared], counts[Change::moved] / 2,
              counts[Change::both]);
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
  std::printf("report: %s/report.html\n", job.folder.out.c_str());
}

void join(CLI::App& command, const JoinJob& job) {
  prepare_run(command, job.folder);
  refuse_to_replace(job.runs, job.folder.out);
  const std::vector<core::JointMap> maps = read_maps(job.runs);
  check_independent(job.runs);
  check_independent(maps, job.runs);
  note_unknown_drives(job.runs, maps);
  supervisor::JoinedSessions joined = supervisor::join_sessions(maps);
  tell_drives(maps, joined);
  const std::vector<ChangedLandmark> shared = shared_landmarks(maps, joined, read_views(job.runs, maps));
  for (const std::string& warning : joined_warnings(joined, shared)) {
    std::fprintf(stderr, "helixnav: warning: %s\n", warning.c_str());
  }
  make_gone_tentative(shared, joined.components);
  const JoinedNames names = joined_names(read_names(job.runs), joined);
  for (const std::string& note : names.notes) std::fprintf(stderr, "helixnav: note: %s\n", note.c_str());
  write_joined(job.folder.out, job.runs, joined, shared, names.of_component);
  if (!job.folder.quiet) say(job, joined, shared);
}

}  // namespace

void add_join_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("join", "Join the maps of several runs that began anywhere");
  const auto job = std::make_shared<JoinJob>();
  command->add_option("RUN", job->runs, "Run folders with a map.bin, oldest first")
      ->required()
      ->expected(2, CLI::detail::expected_max_vector_size);
  add_folder_options(*command, job->folder);
  command->get_option("--out")->required();
  command->footer(
      "No start is given: each map is found on the others by its landmarks, or stays a component of its own. --out "
      "gets\n"
      "map.csv and map.bin (replay --map goes on in them), joins.csv (how each run was placed, and why not),\n"
      "changes.csv (what is new, moved or gone where several runs looked) and report.html, where that is drawn. What "
      "is\n"
      "gone is tentative from here on. To take a run out again, join the others. A run that went on in the map of "
      "another\n"
      "holds that already: give the later one alone.\n\n"
      "Example:\n"
      "  helixnav join runs/robot_1 runs/robot_2 runs/robot_3 --out runs/week\n");
  command->callback([job, command] { join(*command, *job); });
}

}  // namespace helixnav::apps
