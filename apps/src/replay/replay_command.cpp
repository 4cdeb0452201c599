// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "blackout.hpp"
#include "common/commands.hpp"
#include "common/fit_to_recording.hpp"
#include "common/input_files.hpp"
#include "common/missing_warnings.hpp"
#include "common/run_options.hpp"
#include "drive/drive.hpp"
#include "drive/drive_again.hpp"
#include "drive/kept_inputs.hpp"
#include "drive/landmark_names.hpp"
#include "drive/start_by_names.hpp"
#include "drive/start_option.hpp"
#include "drive/truth_on_map.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "helixnav/runs/drive_digest.hpp"
#include "read_to_replay.hpp"
#include "settings/config_file.hpp"
#include "settings/deprecated_keys.hpp"
#include "settings/settings.hpp"
#include "settings/validators.hpp"
#include "settings/vehicle_option.hpp"
#include "spooled_log.hpp"
#include "team/replay_team.hpp"

namespace helixnav::apps {
namespace {

struct ReplayJob {
  std::string path;
  std::string vehicle;
  bool smooth = false;
  bool localize = false;
  std::string map;
  std::optional<SessionStart> start;
  std::vector<Blackout> blackouts;
  RunOptions run;
  Settings settings;
  TeamChoice team;
};

void take_drive_before(const std::string& folder, Drive& task) {
  const std::size_t driven = put_before(runs::read_drive(drive_file_in(folder)), task.recording, task.withheld);
  put_truth_behind(folder, driven, task.recording);
}

/// What a user may not have meant: driving again on the map of the same drive, or from the end of a run that has only its map left.
void note_what_map_holds(const ReplayJob& job, const Drive& task) {
  if (job.start && job.start->kind == SessionStart::Kind::end) {
    if (!job.settings.known_association && lacks_its_drive(job.map))
      std::fprintf(
          stderr,
          "helixnav: note: %s: not there. The run goes on from the map that the one before left (map.bin), not "
          "from its drive and all that its navigator believed\n",
          drive_file_in(job.map).c_str());
    return;
  }
  const std::vector<std::string>& held = task.earlier->map.drives;
  for (const std::string& own : runs::drives_of(task.recording.events)) {
    if (!std::binary_search(held.begin(), held.end(), own)) continue;
    std::fprintf(stderr,
                 "helixnav: note: the map of %s holds this drive already: where it is placed there, what it saw counts "
                 "twice, and the map says that it is surer than it is\n",
                 job.map.c_str());
  }
}

/// To localise in, or to continue in.
void take_map(const ReplayJob& job, Drive& task) {
  if (job.map.empty()) return;
  if (job.localize) {
    task.given_map = read_given_map(job.map);
    task.given_map->start = job.start;
    std::vector<core::LandmarkId> ids;
    for (const core::MapLandmark& landmark : task.given_map->landmarks) ids.push_back(landmark.id);
    call_as_log(job.map, ids, task.recording, task.given_map->landmark_of);
    check_start(*task.given_map);
    warn_of_missing(task.given_map->missing);
  } else {
    task.earlier = read_earlier_session(job.map, job.start.value_or(SessionStart{}));
    call_as_log(job.map, task.earlier->map.joint.ids, task.recording, task.earlier->landmark_of);
    warn_of_missing(task.earlier->missing);
    note_what_map_holds(job, task);
    pass_over_driven(*task.earlier, task.recording, task.withheld);
  }
}

/// The end of the run, with its navigator's full belief.
bool goes_on_from_drive(const ReplayJob& job) {
  return !job.localize && !job.settings.known_association && is_driven_again(job.map, job.start);
}

void refuse_contradictions(const ReplayJob& job) {
  if (job.localize && job.start && job.start->kind == SessionStart::Kind::end)
    throw CLI::ValidationError("--start end", "goes on mapping, and --localize does not map");
  if (job.localize && job.start && job.settings.known_association)
    throw CLI::ValidationError("--start", "with --localize is for logs without identities: these tell where one is");
  if (!job.map.empty() && job.settings.gps.fuse) throw CLI::ValidationError("--gps fuse", "excludes --map");
  if (!job.settings.fastslam.chosen) return;
  if (!job.map.empty()) throw CLI::ValidationError("--map", "--filter fastslam begins a map of its own");
  if (job.smooth) throw CLI::ValidationError("--smooth", "needs the associations of one map; fastslam has many");
}

/// Options that a log of several robots does not have.
void refuse_for_team(const CLI::App& command, const ReplayJob& job, const GivenOptions& given) {
  for (const char* name : {"--smooth", "--map", "--localize", "--blackout", "--vehicle", "--start"}) {
    if (command.get_option(name)->count() > 0) throw CLI::ValidationError(name, "is not for several robots");
  }
  refuse_settings_of_one_robot(given, job.settings);
}

ExitCode replay(CLI::App& command, ReplayJob& job) {
  const GivenOptions given = options_given(command);
  prepare_run(command, job.run);
  refuse_to_replace({job.path, job.vehicle, job.map, job.run.config}, job.run.out);
  warn_of_deprecated_keys(command);
  const SpooledLog log_file(job.path);
  job.path = log_file.path();
  if (logs::is_mrclam(job.path)) {
    refuse_for_team(command, job, given);
    return replay_team(job.path, job.team, job.run, job.settings, dump_config(command));
  }
  refuse_options_of_a_team(command, {"--robots", "--unknown-starts"}, job.settings);
  check_filter(command, given, job.settings.fastslam);
  refuse_contradictions(job);
  const auto begin = std::chrono::steady_clock::now();
  Drive task;
  apply_vehicle(command, job.vehicle, job.path, job.settings);
  LogToReplay log = read_to_replay(job.path, job.settings);
  task.recording = std::move(log.recording);
  task.is_own_log = logs::recognise(job.path) == logs::LogFormat::own;
  if (log.estimated_range_scale) std::printf("range scale estimated from the log: %.4f\n", *log.estimated_range_scale);
  if (!job.blackouts.empty()) task.withheld = withhold(task.recording, job.blackouts);
  apply_log_settings(task.recording, job.settings);
  const bool drives_again = goes_on_from_drive(job);
  drives_again ? take_drive_before(job.map, task) : take_map(job, task);
  print_remarks(task.recording);
  task.navigator = fit_to_recording(job.settings, task.recording);
  fill_drive(task, job.run, dump_config(command) + in_force_text(job.settings, task.navigator, task.recording));
  task.smooth = job.smooth;
  choose_filter(task, job.settings);
  const std::string begun = begin_by_names(task);
  if (!begun.empty()) std::fprintf(stderr, "helixnav: note: %s\n", begun.c_str());
  put_truth_on_map(task);
  if (task.fastslam.chosen) task.manifest.seed = task.fastslam.seed;
  task.manifest.inputs = input_files(job.path);
  for (runs::InputFile& file : vehicle_inputs(job.vehicle)) task.manifest.inputs.push_back(std::move(file));
  if (!job.map.empty()) {
    const std::vector<runs::InputFile> of_map = input_files(job.localize   ? map_file(job.map)
                                                            : drives_again ? drive_file_in(job.map)
                                                                           : joint_map_file_in(job.map));
    task.manifest.inputs.insert(task.manifest.inputs.end(), of_map.begin(), of_map.end());
  }
  task.reading_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return drive(task);
}

void add_blackouts(CLI::App& command, ReplayJob& job) {
  const auto objection_to = [](const std::string& word) {
    std::string objection;
    blackout_from(word, objection);
    return objection;
  };
  const auto take = [&job](const std::vector<std::string>& words) {
    std::string none;
    for (const std::string& word : words) job.blackouts.push_back(blackout_from(word, none));
  };
  command
      .add_option_function<std::vector<std::string>>("--blackout", take,
                                                     "Withhold the scans from T0 to T1, in seconds as in "
                                                     "trajectory.tum; odometry continues. May be given several times")
      ->type_name("T0:T1")
      ->allow_extra_args(false)
      ->check(objection_to);
}

}  // namespace

void add_replay_command(CLI::App& app, ExitCode& code) {
  CLI::App* command = app.add_subcommand("replay", "Navigate along a recorded log");
  const auto job = std::make_shared<ReplayJob>();
  command->add_option("PATH", job->path, "Log: file, folder or zip; the format is recognised. A FIFO: JSON Lines")
      ->required();
  add_vehicle_option(*command, job->vehicle);
  CLI::Option* smooth = command->add_flag(
      "--smooth", job->smooth,
      "Then smooth with the filter's associations: trajectory_final.tum, chi2 and dof (GPS fixes left out)");
  CLI::Option* map = command->add_option(
      "--map", job->map, "Continue in the map of an earlier run: its folder. With --localize a map.csv is enough");
  map->type_name("RUN")->excludes(smooth);
  add_start_option(*command, job->start)->needs(map);
  CLI::Option* localize =
      command->add_flag("--localize", job->localize, "Only estimate the pose, in the given map, which is not changed");
  localize->needs(map);
  add_blackouts(*command, *job);
  const auto take_robots = [job](const std::vector<std::string>& lists) {
    job->team.robots.clear();
    for (const std::string& list : lists) {
      std::istringstream numbers(list);
      for (std::string number; std::getline(numbers, number, ',');) job->team.robots.push_back(std::stoi(number));
    }
  };
  command
      ->add_option_function<std::vector<std::string>>("--robots", take_robots,
                                                      "For a log of several robots: only the robots with these numbers")
      ->check(robot_numbers())
      ->type_name("N,N");
  command->add_flag("--unknown-starts", job->team.unknown_starts,
                    "For a log of several robots: do not take their starts from the truth");
  add_run_options(*command, job->run);
  add_settings(*command, job->settings);
  command->footer(
      "Formats: ACFR text release (folder, zip) and .mat, iSAM/GTSAM and g2o landmark graphs, 2D-I-SLSJF .mat,\n"
      "DLR text, Plaza; MRCLAM (several robots); your own as CSV or JSON Lines with a vehicle.toml (helixnav "
      "new-vehicle DIR writes an "
      "example).\n\n"
      "Examples:\n"
      "  helixnav replay my_drive --out runs/mine\n"
      "  helixnav replay victoria_park_ascii.zip --out runs/vp\n"
      "  helixnav replay isam_victoriaPark.txt --association known --out runs/graph\n"
      "  helixnav replay data_set.mat --out runs/carpark --config mine.toml\n"
      "  helixnav replay MRCLAM_Dataset6 --robots 1,3 --unknown-starts --out runs/team\n"
      "  helixnav replay tuesday --map runs/monday --out runs/tuesday\n"
      "  helixnav replay data_set.mat --filter fastslam --fastslam.detection_probability 0.5 --out runs/particles\n"
      "  helixnav replay map.circles --localize --map runs/optimum --out runs/located\n"
      "  helixnav replay victoria_park_ascii.zip --blackout 600:660 --blackout 900:930 --out runs/blind\n");
  command->callback([command, job, &code] { code = replay(*command, *job); });
}

}  // namespace helixnav::apps
