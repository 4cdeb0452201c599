// SPDX-License-Identifier: BSD-3-Clause
#include "drive_again.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <utility>
#include <variant>

#include "helixnav/core/errors.hpp"
#include "helixnav/runs/drive_digest.hpp"
#include "helixnav/runs/run_folder.hpp"

namespace helixnav::apps {
namespace {

const core::Scan* first_scan(const std::vector<core::Event>& events) {
  for (const core::Event& event : events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan != nullptr && !scan->observations.empty()) return scan;
  }
  return nullptr;
}

bool is_same(const core::Scan& one, const core::Scan& other) {
  return one.t_ns == other.t_ns &&
         std::equal(
             one.observations.begin(), one.observations.end(), other.observations.begin(), other.observations.end(),
             [](const core::Observation& a, const core::Observation& b) { return a.kind == b.kind && a.z == b.z; });
}

bool holds(const std::vector<core::Event>& events, const core::Scan& scan) {
  return std::any_of(events.begin(), events.end(), [&](const core::Event& event) {
    const auto* one = std::get_if<core::Scan>(&event);
    return one != nullptr && is_same(*one, scan);
  });
}

void move_clock(core::Recording& recording, core::Nanoseconds by_ns) {
  for (core::Event& event : recording.events) std::visit([&](auto& one) { one.t_ns += by_ns; }, event);
  for (core::TruePose& pose : recording.true_poses) pose.t_ns += by_ns;
  for (core::TruePosition& position : recording.true_positions) position.t_ns += by_ns;
  for (core::Nanoseconds& t_ns : recording.true_carries_ns) t_ns += by_ns;
  for (core::Nanoseconds& t_ns : recording.true_slips_ns) t_ns += by_ns;
}

/// How many scans of the recording were already driven, and are left out.
std::size_t begin_behind(const std::vector<core::Event>& before, core::Recording& recording) {
  if (before.empty() || recording.events.empty()) return 0;
  const core::Nanoseconds end_ns = core::time_of(before.back());
  const core::Nanoseconds begin_ns = core::time_of(recording.events.front());
  const core::Scan* first = first_scan(recording.events);
  if (first != nullptr && holds(before, *first)) return pass_over(end_ns, recording);
  if (begin_ns >= end_ns) return 0;
  move_clock(recording, end_ns - begin_ns);
  std::ostringstream moved;
  moved << "the log begins " << core::seconds(end_ns - begin_ns)
        << " s before the run of --map ended, by another clock: its times are moved";
  recording.remarks.push_back(moved.str());
  return 0;
}

/// Observations of scans that were already driven are left out, and the others are assigned their new scan index.
void take_off_shared(std::size_t driven, std::size_t before, core::Recording& recording) {
  std::vector<core::SharedObservation>& shared = recording.shared_observations;
  shared.erase(std::remove_if(shared.begin(), shared.end(), [&](const auto& one) { return one.scan < driven; }),
               shared.end());
  for (core::SharedObservation& one : shared) one.scan += before - driven;
}

/// The first entries, of scans that were already driven, are replaced by those of the earlier drive.
template <class Entries>
void exchange_front(Entries& entries, std::size_t driven, Entries before) {
  entries.erase(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(std::min(driven, entries.size())));
  entries.insert(entries.begin(), before.begin(), before.end());
}

}  // namespace

std::string drive_file_in(const std::string& folder) { return (std::filesystem::path(folder) / "drive.bin").string(); }

std::unique_ptr<runs::DriveFile> kept_drive(const Drive& job) {
  if (job.out.empty() || job.known_association || job.fastslam.chosen || job.given_map || job.earlier) return nullptr;
  return std::make_unique<runs::DriveFile>(drive_file_in(job.out), job.recording.start);
}

bool is_driven_again(const std::string& folder, const std::optional<SessionStart>& start) {
  return start && start->kind == SessionStart::Kind::end && std::filesystem::exists(drive_file_in(folder));
}

bool lacks_its_drive(const std::string& folder) {
  const std::filesystem::path path(folder);
  if (std::filesystem::exists(drive_file_in(folder)) || !std::filesystem::exists(path / "manifest.json")) return false;
  const std::string command = runs::read_manifest(folder).command;
  return command.find(" --map") == std::string::npos && command.find("association known") == std::string::npos;
}

std::size_t pass_over(core::Nanoseconds end_ns, core::Recording& recording) {
  std::vector<core::Event>& events = recording.events;
  const auto rest = std::find_if(events.begin(), events.end(),
                                 [&](const core::Event& event) { return core::time_of(event) > end_ns; });
  const auto scans = static_cast<std::size_t>(std::count_if(
      events.begin(), rest, [](const core::Event& event) { return std::holds_alternative<core::Scan>(event); }));
  events.erase(events.begin(), rest);
  return scans;
}

void pass_over_driven(const EarlierSession& earlier, core::Recording& recording, std::vector<bool>& withheld) {
  if (earlier.start.kind != SessionStart::Kind::end || !earlier.ended_ns) return;
  const std::vector<std::string> own = runs::drives_of(recording.events), &drives = earlier.map.drives;
  if (own.empty() || std::find(drives.begin(), drives.end(), own.front()) == drives.end()) return;
  const std::size_t driven = pass_over(*earlier.ended_ns, recording);
  const std::vector<core::Event>& rest = recording.events;
  if (std::none_of(rest.begin(), rest.end(), [](const auto& one) { return std::holds_alternative<core::Scan>(one); })) {
    throw core::InputError("the run of --map drove the whole log: after its last scan there is nothing to go on with");
  }
  if (!withheld.empty()) exchange_front(withheld, driven, {});
  if (!recording.labels.empty()) exchange_front(recording.labels, driven, {});
  take_off_shared(driven, 0, recording);
  recording.remarks.push_back(std::to_string(driven) +
                              " scans of the log were driven by the run of --map: passed over");
}

std::vector<std::string> drives_in_map(const Drive& job, const runs::Run& run) {
  std::vector<std::string> own = runs::drives_of(job.recording.events);
  const bool is_on_earlier =
      job.earlier && (job.earlier->start.kind != SessionStart::Kind::unknown || runs::is_on_earlier_map(run));
  return is_on_earlier ? runs::united_drives(std::move(own), job.earlier->map.drives) : own;
}

std::size_t put_before(runs::FedDrive before, core::Recording& recording, std::vector<bool>& withheld) {
  const std::size_t driven = begin_behind(before.events, recording);
  std::vector<std::vector<core::Label>> labels;
  for (const core::Event& event : before.events) {
    if (const auto* scan = std::get_if<core::Scan>(&event))
      labels.emplace_back(scan->observations.size(), core::no_label);
  }
  recording.remarks.push_back(std::to_string(labels.size()) + " scans of the run of --map are driven again first" +
                              (driven > 0 ? ", " + std::to_string(driven) + " of the log are among them" : ""));
  if (!withheld.empty()) exchange_front(withheld, driven, std::vector<bool>(labels.size(), false));
  take_off_shared(driven, labels.size(), recording);
  if (!recording.labels.empty()) exchange_front(recording.labels, driven, std::move(labels));
  recording.start = before.start;
  recording.events.insert(recording.events.begin(), std::make_move_iterator(before.events.begin()),
                          std::make_move_iterator(before.events.end()));
  return driven;
}

}  // namespace helixnav::apps
