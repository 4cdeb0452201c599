// SPDX-License-Identifier: BSD-3-Clause
#include "replay.hpp"

#include <exception>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "common/input_files.hpp"
#include "common/timed.hpp"
#include "drive/check_drive.hpp"
#include "drive/drive.hpp"
#include "drive/drive_again.hpp"
#include "drive/estimator.hpp"
#include "drive/given_map.hpp"
#include "drive/keeping.hpp"
#include "drive/kept_inputs.hpp"
#include "drive/landmark_names.hpp"
#include "drive/start_by_names.hpp"
#include "drive/systematic_motion.hpp"
#include "drive/truth_on_map.hpp"
#include "drive/withholding.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/reports/finish_run.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "signals.hpp"
#include "smooth/smooth_drive.hpp"

namespace helixnav::python {
namespace {

void refuse_contradictions(const Log& log, const ReplayWishes& wishes) {
  using Kind = apps::SessionStart::Kind;
  const auto refuse = [](bool contradiction, const char* why) {
    if (contradiction) throw core::PreconditionError(std::string("replay: ") + why);
  };
  refuse(!wishes.map && wishes.start, "start is a place on a map: give map, too");
  refuse(!wishes.map && wishes.localize, "localize needs a map");
  refuse(wishes.map && wishes.smooth, "smooth takes no map");
  refuse(wishes.localize && wishes.start && wishes.start->kind == Kind::end,
         "start='end' goes on mapping, and localize does not map");
  refuse(wishes.localize && wishes.start && log.known_association,
         "start with localize is for logs without identities: these tell where one is");
  refuse(log.fastslam.chosen && wishes.map, "FastSLAM begins a map of its own");
  refuse(log.fastslam.chosen && wishes.smooth, "smooth needs the associations of one map; FastSLAM has many");
}

/// Whether the session goes on from where the run of --map ended, with all that its navigator believed.
bool goes_on_from_drive(const Log& log, const ReplayWishes& wishes) {
  return wishes.map && !wishes.map->map && !wishes.localize && !log.known_association &&
         apps::is_driven_again(wishes.map->path.string(), wishes.start);
}

runs::RunManifest manifest_of(const Log& log, const ReplayWishes& wishes) {
  runs::RunManifest manifest;
  manifest.version = core::version();
  manifest.commit = core::commit();
  manifest.command = "python: helixnav.replay";
  manifest.recording = log.recording.name;
  manifest.config = log.config;
  manifest.seed = log.fastslam.chosen ? log.fastslam.seed : log.seed;
  if (wishes.out.empty()) return manifest;  // digests take their time, and nobody would read them
  std::vector<std::string> files = log.files;
  if (wishes.map && !wishes.map->map) {
    const std::string path = wishes.map->path.string();
    files.push_back(wishes.localize                   ? apps::map_file(path)
                    : goes_on_from_drive(log, wishes) ? apps::drive_file_in(path)
                                                      : apps::joint_map_file_in(path));
  }
  for (const std::string& file : files) {
    const std::vector<runs::InputFile> inputs = apps::input_files(file);
    manifest.inputs.insert(manifest.inputs.end(), inputs.begin(), inputs.end());
  }
  return manifest;
}

/// What the log calls the landmarks of a map in a folder.
void take_names(const ReplayWishes& wishes, apps::Drive& job) {
  if (wishes.map->map) return;
  std::vector<core::LandmarkId> ids;
  if (wishes.localize) {
    for (const core::MapLandmark& landmark : job.given_map->landmarks) ids.push_back(landmark.id);
  } else {
    ids = job.earlier->map.joint.ids;
  }
  auto& landmark_of = wishes.localize ? job.given_map->landmark_of : job.earlier->landmark_of;
  apps::call_as_log(wishes.map->path.string(), ids, job.recording, landmark_of);
}

void take_map(const ReplayWishes& wishes, apps::Drive& job) {
  if (!wishes.map) return;
  const std::optional<core::JointMap>& map = wishes.map->map;
  if (wishes.localize) {
    job.given_map = map ? apps::given_map(*map) : apps::read_given_map(wishes.map->path.string());
    job.given_map->start = wishes.start;
    apps::check_start(*job.given_map);
  } else {
    const apps::SessionStart start = wishes.start.value_or(apps::SessionStart{});
    job.earlier =
        map ? apps::earlier_session(*map, start, "map") : apps::read_earlier_session(wishes.map->path.string(), start);
    apps::pass_over_driven(*job.earlier, job.recording, job.withheld);
  }
  take_names(wishes, job);
}

apps::Drive job_of(const Log& log, const ReplayWishes& wishes) {
  apps::Drive job;
  job.recording = log.recording;
  job.navigator = log.navigator;
  job.fastslam = log.fastslam;
  job.known_association = log.known_association;
  job.is_own_log = log.is_own_log;
  job.withheld = log.withheld;
  job.smooth = wishes.smooth;
  job.out = wishes.out;
  if (goes_on_from_drive(log, wishes)) {
    const std::string folder = wishes.map->path.string();
    const std::size_t driven =
        apps::put_before(runs::read_drive(apps::drive_file_in(folder)), job.recording, job.withheld);
    apps::put_truth_behind(folder, driven, job.recording);
  } else {
    take_map(wishes, job);
    apps::begin_by_names(job);
    apps::put_truth_on_map(job);
  }
  job.manifest = manifest_of(log, wishes);
  return job;
}

/// How a drive came to its end.
struct Ended {
  std::string broken;              ///< what broke of the mathematics, and where; empty when nothing did
  std::exception_ptr interrupted;  ///< by what a signal raised, such as KeyboardInterrupt
  bool is_whole() const { return broken.empty() && !interrupted; }
};

/// Feeds all events.
Ended navigate(const apps::Drive& job, apps::Estimator& estimator, runs::RunWriter* writer,
               runs::RunRecorder& recorder) {
  const std::unique_ptr<runs::DriveFile> file = apps::kept_drive(job);
  apps::Timed timed(estimator);
  apps::Keeping kept(timed, file.get());
  apps::Withholding seen(kept, job.withheld, estimator.pose);
  core::EventLoop loop(job.recording.events, seen);
  SignalWatch signals;
  Ended ended;
  try {
    while (const std::optional<core::StepReport> step = loop.next()) {
      const double microseconds = seen.last_scan_was_withheld() ? 0.0 : 1e6 * timed.last_s();
      if (writer != nullptr) writer->write(*step, microseconds);
      recorder.add(*step, microseconds);
      const bool is_looked_at = writer != nullptr && recorder.wants_map();
      if (is_looked_at) recorder.add_map(estimator.sketch ? estimator.sketch() : estimator.map());
      signals.heed();
    }
  } catch (const core::NumericalError& error) {
    ended.broken = error.what();  // with step and time
  } catch (const py::error_already_set&) {
    ended.interrupted = std::current_exception();
  }
  if (file) file->finish();
  return ended;
}

}  // namespace

runs::Run replay(const Log& log, const ReplayWishes& wishes) {
  refuse_contradictions(log, wishes);
  const apps::Drive job = job_of(log, wishes);
  apps::refuse_to_replace(log.files, job.out);
  if (wishes.map && !wishes.map->map) apps::refuse_to_replace({wishes.map->path.string()}, job.out);
  apps::check_drive(job);
  using IfNotEmpty = runs::RunWriter::IfNotEmpty;
  std::unique_ptr<runs::RunWriter> writer;
  if (!job.out.empty()) {
    writer = std::make_unique<runs::RunWriter>(job.out, job.manifest, job.recording,
                                               wishes.overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  }
  runs::RunRecorder recorder(job.out, job.manifest, job.recording);
  apps::LabelAgreement agreement;
  apps::Estimator estimator = apps::estimator_of(job, agreement);
  const Ended ended = navigate(job, estimator, writer.get(), recorder);
  if (ended.interrupted && !writer) std::rethrow_exception(ended.interrupted);
  runs::Run run = recorder.finish(estimator.map());
  run.names = apps::landmark_names(job, run);
  run.joint_map = estimator.joint_map();
  if (run.joint_map) run.joint_map->drives = apps::drives_in_map(job, run);
  if (estimator.parts_apart) run.parts_apart = estimator.parts_apart();
  if (estimator.particle_end) run.particle_end = estimator.particle_end();
  run.numbers = apps::numbers_of(agreement);
  if (ended.is_whole() && job.may_err_systematically()) apps::note_systematic_errors(job.recording, run);
  if (job.smooth && ended.is_whole()) apps::smooth(job, run);
  if (writer) reports::finish_run(run, *writer);
  if (ended.interrupted) std::rethrow_exception(ended.interrupted);
  if (!ended.broken.empty()) throw core::NumericalError(ended.broken);
  return run;
}

}  // namespace helixnav::python
