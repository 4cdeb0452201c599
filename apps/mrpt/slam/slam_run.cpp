// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_run.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "common/interrupt.hpp"
#include "common/progress_bar.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/mrpt_adapter/run_access.hpp"
#include "helixnav/reports/finish_run.hpp"
#include "helixnav/reports/summary.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "reading/read_rawlog.hpp"
#include "slam/ground_truth.hpp"
#include "slam/live_view.hpp"
#include "slam/rawlog_source.hpp"
#include "slam/slam_config.hpp"
#include "slam/slam_feed.hpp"
#include "slam/slam_files.hpp"

namespace helixnav::apps {
namespace {

using Clock = std::chrono::steady_clock;
using mrpt_adapter::RunAccess;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

bool shows_landmarks(const mrpt::serialization::CSerializable* object) {
  if (const auto* frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(object)) {
    return std::any_of(frame->begin(), frame->end(), [](const auto& one) { return shows_landmarks(one.get()); });
  }
  return dynamic_cast<const mrpt::obs::CObservationBearingRange*>(object) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(object) != nullptr;
}

void check_that_landmarks_are_seen(const RawlogSource& source, const std::string& path) {
  const auto shows = [](const auto& entry) { return shows_landmarks(entry.get()); };
  if (std::any_of(source.entries().begin(), source.entries().end(), shows)) return;
  throw core::InputError(path +
                         ": nothing to navigate by: no CObservationBearingRange and no CObservation2DRangeScan in " +
                         std::to_string(source.entries().size()) + " entries" +
                         (source.offset() > 0 ? " behind rawlog_offset = " + std::to_string(source.offset()) : "") +
                         (source.damage().empty() ? "" : "; " + source.damage()));
}

runs::RunManifest manifest_of(const SlamJob& job, const std::string& rawlog, const std::vector<std::string>& others) {
  runs::RunManifest manifest;
  manifest.version = core::version();
  manifest.commit = core::commit();
  manifest.command = runs::command_text(job.command_line);
  manifest.recording = rawlog;
  std::ifstream file(job.config);
  std::ostringstream config;
  config << file.rdbuf();
  manifest.config = config.str();
  std::vector<std::string> names{job.config, rawlog};
  names.insert(names.end(), others.begin(), others.end());
  for (const std::string& name : names) manifest.inputs.push_back({name, runs::sha256_of_file(name)});
  return manifest;
}

/// One run from its first step to its last file.
class Run {
 public:
  Run(const SlamConfig& config, RawlogSource& source, std::string out)
      : config_(config), source_(source), out_(std::move(out)), damage_(source.damage()) {
    if (!config_.map.empty()) builder_.initializeFromRun(config_.map);
    // The log's truth is in the log's frame, and the run in the map frame.
    if (!config_.builder.gps_use && config_.map.empty())
      add_true_positions(source_.entries(), config_.builder, recording_);
    if (!config_.ground_truth_file.empty()) recording_.true_landmarks = read_true_landmarks(config_.ground_truth_file);
    if (!config_.ground_truth_file_robot.empty()) true_path_m_ = read_true_path(config_.ground_truth_file_robot);
  }

  void open_folder(const runs::RunManifest& manifest, bool overwrite) {
    using IfNotEmpty = runs::RunWriter::IfNotEmpty;
    recording_.name = manifest.recording;
    writer_ = std::make_unique<runs::RunWriter>(out_, manifest, recording_,
                                                overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
    recorder_ = std::make_unique<runs::RunRecorder>(out_, manifest, recording_);
    files_ = std::make_unique<SlamFiles>(config_, out_, true_path_m_);
  }

  void navigate(bool quiet) {
    LiveView live(config_);
    SlamFeed feed(builder_, [&](const mrpt::obs::CObservation& seen) {
      note(seen);
      live.show(builder_, steps_, false);
    });
    ProgressBar progress("navigating", source_.size(), quiet);
    while (!interrupted()) {
      const std::optional<RawlogTurn> turn = source_.next();
      if (!turn) break;
      try {
        feed.take(*turn);
      } catch (const core::InputError& error) {
        damage_ = "entry " + std::to_string(source_.last_entry()) + ": " + error.what();
        break;
      }
      progress.advance_to(source_.last_entry());
    }
    if (steps_ > 0) live.show(builder_, steps_, true);
  }

  void finish(double reading_s, double navigating_s) {
    if (steps_ == 0) return;
    if (writer_) {
      runs::Run run = recorder_->finish(RunAccess::map(builder_));
      run.joint_map = RunAccess::joint_map(builder_);
      run.timing = {{"median_us", median_us()}, {"reading_s", reading_s}, {"navigating_s", navigating_s}};
      std::fputs(reports::evaluation_text(reports::finish_run(run, *writer_)).c_str(), stdout);
    }
    if (files_) files_->write_end(builder_);
    print_summary();
  }

  std::size_t steps() const { return steps_; }
  const std::string& damage() const { return damage_; }

 private:
  void note(const mrpt::obs::CObservation& seen) {
    for (const mrpt_adapter::Step& step : RunAccess::last_steps(builder_)) {
      if (writer_) {
        writer_->write(step.report, step.microseconds);
        recorder_->add(step.report, step.microseconds);
      }
      step_us_.push_back(step.microseconds);
      for (const core::Decision& decision : step.report.decisions) {
        if (core::is_closure(decision)) ++closings_[core::row_of(decision).verdict];
      }
    }
    if (files_) files_->write_step(builder_, seen, steps_);
    ++steps_;
  }

  double median_us() {
    const auto middle = step_us_.begin() + static_cast<std::ptrdiff_t>(step_us_.size() / 2);
    std::nth_element(step_us_.begin(), middle, step_us_.end());
    return *middle;
  }

  void print_summary() {
    std::printf("closings             %d accepted, %d refused, %d on new ground, %d left undecided\n",
                closings_["accepted"], closings_["refused"], closings_["new-ground"], closings_["undecided"]);
    std::printf("landmarks            %zu\n", RunAccess::map(builder_).size());
    if (!recording_.true_landmarks.empty()) {
      const LandmarkErrors errors = landmark_errors(builder_, recording_.true_landmarks);
      std::printf("landmarks to truth   mean %.6f m, largest %.6f m, of %zu (%zu without truth), not aligned\n",
                  errors.mean_m, errors.largest_m, errors.compared, errors.without_truth);
    }
    std::printf("time a step          median %.1f us\n", median_us());
    if (writer_) std::printf("run folder: %s   report: %s/report.html\n", out_.c_str(), out_.c_str());
  }

  const SlamConfig& config_;
  RawlogSource& source_;
  std::string out_;
  std::string damage_;
  core::Recording recording_;  ///< truth only
  std::vector<Eigen::Vector2d> true_path_m_;
  mrpt_adapter::MapBuilder builder_{config_.builder};
  std::unique_ptr<runs::RunWriter> writer_;
  std::unique_ptr<runs::RunRecorder> recorder_;
  std::unique_ptr<SlamFiles> files_;
  std::size_t steps_ = 0;
  std::vector<double> step_us_;
  std::map<std::string, int> closings_;
};

std::string rawlog_of(const SlamJob& job, const SlamConfig& config) {
  if (!job.rawlog.empty()) return job.rawlog;
  if (!config.rawlog_file.empty()) return config.rawlog_file;
  throw core::InputError(job.config +
                         ": [MappingApplication] rawlog_file is missing, and the command line names no rawlog");
}

}  // namespace

ExitCode run_slam(const SlamJob& job) {
  const Clock::time_point begin = Clock::now();
  const SlamConfig config = read_slam_config(job.config);
  const std::string rawlog = rawlog_of(job, config);
  const std::string out = job.out.empty() ? config.logOutput_dir : job.out;
  if (!job.quiet) {
    for (const std::string& key : config.without_effect) {
      std::fprintf(stderr, "helixnav-slam: without effect here: %s\n", key.c_str());
    }
  }
  catch_interrupts();
  RawlogSource source(rawlog, config.rawlog_offset, vehicle_for(config.builder.detector));
  check_that_landmarks_are_seen(source, rawlog);
  Run run(config, source, out);
  std::vector<std::string> others;
  for (const std::string& name : {config.ground_truth_file, config.ground_truth_file_robot}) {
    if (!name.empty()) others.push_back(name);
  }
  if (!config.map.empty()) others.push_back(config.map + "/map.bin");
  if (!out.empty()) run.open_folder(manifest_of(job, rawlog, others), job.overwrite || config.overwrite);
  const double reading_s = seconds_since(begin);
  run.navigate(job.quiet);
  run.finish(reading_s, seconds_since(begin) - reading_s);
  if (!run.damage().empty()) {
    throw core::InputError(run.damage() + "; " + std::to_string(run.steps()) + " steps before that were navigated" +
                           (out.empty() ? "" : " and written to " + out));
  }
  if (!interrupted()) return ExitCode::ok;
  std::fprintf(stderr, "helixnav-slam: interrupted after %zu steps\n", run.steps());
  return ExitCode::interrupted;
}

}  // namespace helixnav::apps
