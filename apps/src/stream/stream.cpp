// SPDX-License-Identifier: BSD-3-Clause
#include "stream.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "answer.hpp"
#include "common/interrupt.hpp"
#include "common/timed.hpp"
#include "drive/drive_again.hpp"
#include "drive/keeping.hpp"
#include "drive/systematic_motion.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/logs/own_stream.hpp"
#include "helixnav/reports/finish_run.hpp"
#include "helixnav/reports/run_warnings.hpp"
#include "helixnav/runs/drive_file.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "line_channel.hpp"
#include "live_navigator.hpp"

namespace helixnav::apps {
namespace {

class Stream {
 public:
  explicit Stream(const StreamJob& job)
      : job_(job),
        input_(*job.settings.logs.vehicle, job.settings.known_association),
        navigator_(job.settings),
        channel_(job.listen) {
    if (!job.listen.empty()) std::fprintf(stderr, "helixnav: listening on %s\n", channel_.address().c_str());
  }

  /// Whatever stops it, the client is told.
  ExitCode run() {
    try {
      return answer_all();
    } catch (const std::exception& error) {
      send_end(error.what());
      throw;
    }
  }

 private:
  ExitCode answer_all() {
    if (!job_.resume.empty()) drive_again();
    std::string line;
    while (reader_is_there_ && channel_.next(line)) answer(input_.take(line, channel_.line_number()));
    if (reader_is_there_ && !interrupted()) answer_end_of_input();
    return end();
  }

  /// The last scans: more of them might have come, or the odometry does not cover their motion to its end.
  void answer_end_of_input() {
    input_has_ended_ = true;
    if (drive_) drive_->end_input();
    drive_held_back();
    answer(input_.finish());
  }

  void answer(logs::StreamedEvents next) {
    for (const std::string& remark : next.remarks) send(note_answer(remark));
    for (const logs::RefusedLine& refused : next.refused) refuse(refused);
    if (!next.recording.events.empty()) take_up_held_back(next.recording.events);
    if (driven_until_ns_) {
      const std::size_t scans = pass_over(*driven_until_ns_, next.recording);
      next.lines.erase(next.lines.begin(), next.lines.begin() + static_cast<std::ptrdiff_t>(scans));
    }
    navigator_.prepare(next.recording);
    open_folder_if_due(next.recording);
    navigate(next);
  }

  /// The input of the drive that is continued; into the run folder as well, without answers. Events that only the end of its
  /// input produced are held back: they may come again, and differently.
  void drive_again() {
    runs::FedDrive fed = runs::read_drive(drive_file_in(job_.resume));
    const auto end = fed.events.begin() + static_cast<std::ptrdiff_t>(fed.before_end_of_input);
    held_back_.assign(end, fed.events.end());
    fed.events.erase(end, fed.events.end());
    start_ = fed.start;
    drive_fed(std::move(fed.events));
    send(note_answer(std::to_string(steps_) + " scans of " + job_.resume + " are driven again"));
  }

  void drive_fed(std::vector<core::Event> events) {
    if (events.empty()) return;
    driven_until_ns_ = core::time_of(events.back());
    core::Recording before;
    before.start = start_;
    before.events = std::move(events);
    before.extraneous_per_scan = 0.0;  // to be learnt, as of all that a stream reads (logs::OwnStream)
    if (!navigator_.has_begun()) navigator_.begin_with(before);
    open_folder_if_due(before);
    Timed timed(navigator_);
    Keeping kept(timed, drive_.get());
    core::EventLoop loop(before.events, kept, steps_);
    while (const std::optional<core::StepReport> step = loop.next()) {
      if (writer_) write(*step, 1e6 * timed.last_s());
    }
    steps_ = loop.steps();
  }

  void drive_held_back() { drive_fed(std::exchange(held_back_, {})); }

  /// New input continues after what was held back, or it is the same again, as more is known now.
  void take_up_held_back(const std::vector<core::Event>& next) {
    if (held_back_.empty()) return;
    const auto is_first_scan = [](const core::Event& event) { return std::holds_alternative<core::Scan>(event); };
    const auto first = std::find_if(next.begin(), next.end(), is_first_scan);
    if (first == next.end()) return;
    if (core::time_of(*first) > core::time_of(held_back_.back())) return drive_held_back();
    held_back_.clear();
  }

  /// A scan on which the mathematics breaks down is left out; the navigator is in its state before it.
  void navigate(const logs::StreamedEvents& next) {
    Timed timed(navigator_);
    Keeping kept(timed, drive_.get());
    feed_live(
        next, kept, steps_,
        [&](const core::StepReport& step, std::size_t line) { answer(step, line, 1e6 * timed.last_s()); },
        [&](std::size_t line, const std::exception& error, bool is_numerical) {
          broken_ += is_numerical ? 1 : 0;
          refuse({line, "", error.what()});
        });
  }

  void answer(const core::StepReport& step, std::size_t line, double microseconds) {
    if (!job_.out.empty()) write(step, microseconds);
    send(scan_answer(step, line));
  }

  void write(const core::StepReport& step, double microseconds) {
    writer_->write(step, microseconds);
    if (std::any_of(step.decisions.begin(), step.decisions.end(), core::begins_part)) {
      solved_before_.insert(solved_before_.end(), solved_.begin(), solved_.end());
      solved_.clear();
    }
    if (!step.solved.empty()) solved_ = step.solved;
  }

  void open_folder_if_due(const core::Recording& next) {
    if (job_.out.empty() || writer_ || !navigator_.has_begun()) return;
    open_folder();
    if (!job_.settings.known_association) {
      drive_ = std::make_unique<runs::DriveFile>(drive_file_in(job_.out), next.start);
      if (input_has_ended_) drive_->end_input();
    }
  }

  void open_folder() {
    using IfNotEmpty = runs::RunWriter::IfNotEmpty;
    runs::RunManifest manifest = job_.manifest;
    manifest.config += navigator_.lengths_text();
    core::Recording recording;
    recording.name = manifest.recording;
    writer_ = std::make_unique<runs::RunWriter>(job_.out, manifest, recording,
                                                job_.overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  }

  void send(std::string line) { reader_is_there_ = reader_is_there_ && channel_.send(std::move(line)); }

  void send_end(const std::string& why) {
    if (!std::exchange(end_is_told_, true)) send(end_answer(steps_, refused_, why));
  }

  void refuse(const logs::RefusedLine& refused) {
    ++refused_;
    send(refused_answer(refused));
  }

  /// The steps are read back from the folder: memory does not grow with the drive.
  void finish_folder() {
    if (!writer_) open_folder();
    if (drive_) drive_->finish();
    runs::Run run = runs::read_run(job_.out);
    run.map = navigator_.map();
    run.joint_map = navigator_.joint_map();
    run.parts_apart = navigator_.maps_apart();
    solved_before_.insert(solved_before_.end(), solved_.begin(), solved_.end());
    runs::correct_path(run, solved_before_);
    run.finished = true;
    if (drive_ && job_.resume.empty()) {
      core::Recording recording;
      recording.events = runs::read_drive(drive_file_in(job_.out)).events;
      note_systematic_errors(recording, run);
    }
    const evaluation::Evaluation evaluation = reports::finish_run(run, *writer_);
    for (const std::string& warning : reports::warnings_of(run, evaluation)) {
      std::fprintf(stderr, "helixnav: warning: %s\n", warning.c_str());
    }
    std::fprintf(stderr, "run folder: %s   report: %s/report.html\n", job_.out.c_str(), job_.out.c_str());
  }

  ExitCode end() {
    const bool stopped = interrupted();
    send_end(stopped ? "signal" : "end of input");
    if (!job_.out.empty()) finish_folder();
    std::fprintf(stderr, "helixnav: %lld scans answered, %lld lines refused\n", static_cast<long long>(steps_),
                 static_cast<long long>(refused_));
    if (!reader_is_there_) {
      std::fprintf(stderr, "helixnav: %s\n", channel_.why_nobody_reads().c_str());
      return ExitCode::data;
    }
    if (stopped) return ExitCode::interrupted;
    return broken_ > 0 ? ExitCode::numerical : ExitCode::ok;
  }

  const StreamJob& job_;
  logs::OwnStream input_;
  LiveNavigator navigator_;
  LineChannel channel_;
  std::unique_ptr<runs::RunWriter> writer_;
  std::unique_ptr<runs::DriveFile> drive_;            ///< beside it, so that the drive can be continued
  std::vector<core::StampedPose> solved_;             ///< the last time
  std::vector<core::StampedPose> solved_before_;      ///< of parts of the drive before the vehicle was carried
  std::optional<core::Nanoseconds> driven_until_ns_;  ///< events up to here were driven before
  core::PoseGaussian start_;                          ///< of the drive that is continued
  std::vector<core::Event> held_back_;                ///< of it, after the end of its input
  bool input_has_ended_ = false;
  bool reader_is_there_ = true, end_is_told_ = false;
  std::int64_t steps_ = 0, refused_ = 0, broken_ = 0;
};

}  // namespace

ExitCode stream(const StreamJob& job) {
  catch_interrupts();
  return Stream(job).run();
}

}  // namespace helixnav::apps
