// SPDX-License-Identifier: BSD-3-Clause
#include "reading/read_rawlog.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <mrpt/obs/CAction.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"
#include "reading/rawlog_stream.hpp"

namespace helixnav::apps {
namespace {

using mrpt_adapter::MapBuilderOptions;

core::Nanoseconds needed_time_of(const mrpt::obs::CObservation& observation) {
  const auto t_ns = mrpt_adapter::time_of(observation);
  if (!t_ns) throw core::InputError(std::string("a ") + observation.GetRuntimeClass()->className + " without time");
  return *t_ns;
}

/// Fixes of one antenna, from the first on.
class Fixes {
 public:
  Fixes(const MapBuilderOptions& options, core::Recording& recording) : options_(options), recording_(recording) {}

  void take(const mrpt::obs::CObservation& observation) {
    const auto* gps = dynamic_cast<const mrpt::obs::CObservationGPS*>(&observation);
    if (gps == nullptr) return;
    const auto t_ns = mrpt_adapter::time_of(*gps);
    const auto position = mrpt_adapter::position_of(*gps);
    if (!t_ns || !position) return;
    if (!reference_) reference_ = position;
    const core::AbsoluteFix fix = mrpt_adapter::fix_of(*gps, *position, *reference_, options_);
    recording_.true_positions.push_back({*t_ns, fix.position_world_m});
    recording_.antenna_robot_m = fix.antenna_robot_m;
  }

 private:
  const MapBuilderOptions& options_;
  core::Recording& recording_;
  std::optional<mrpt_adapter::GpsReference> reference_;
};

class Recorder {
 public:
  Recorder(std::string name, const MapBuilderOptions& options) : options_(options) {
    recording_.name = std::move(name);
  }

  void take(const mrpt::serialization::CSerializable& entry) {
    if (const auto* actions = dynamic_cast<const mrpt::obs::CActionCollection*>(&entry)) {
      if (const auto moved = mrpt_adapter::odometry_of(*actions)) move(*moved);
    } else if (const auto* action = dynamic_cast<const mrpt::obs::CAction*>(&entry)) {
      mrpt::obs::CActionCollection alone;
      alone.insertPtr(mrpt::obs::CAction::Ptr(static_cast<mrpt::obs::CAction*>(action->clone())));
      if (const auto moved = mrpt_adapter::odometry_of(alone)) move(*moved);
    } else if (const auto* frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(&entry)) {
      for (const auto& observation : *frame) see(*observation);
    } else if (const auto* observation = dynamic_cast<const mrpt::obs::CObservation*>(&entry)) {
      see(*observation);
    }
  }

  core::Recording finish() {
    const auto is_label = [](const std::vector<core::Label>& of_scan) {
      return std::any_of(of_scan.begin(), of_scan.end(), [](core::Label label) { return label != core::no_label; });
    };
    if (std::none_of(recording_.labels.begin(), recording_.labels.end(), is_label)) recording_.labels.clear();
    return std::move(recording_);
  }

 private:
  void move(const core::Odometry& odometry) { motion_ = motion_ ? core::chain(*motion_, odometry) : odometry; }

  void see(const mrpt::obs::CObservation& observation) {
    if (const auto* landmarks = dynamic_cast<const mrpt::obs::CObservationBearingRange*>(&observation)) {
      add(mrpt_adapter::scan_of(*landmarks, options_), observation);
    } else if (const auto* ranges = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation)) {
      add(mrpt_adapter::scan_of(*ranges, options_), observation);
    } else if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
      if (last_reading_) move(mrpt_adapter::increment_between(*last_reading_, odometry->odometry, options_));
      last_reading_ = odometry->odometry;
    }
  }

  void add(mrpt_adapter::NamedScan named, const mrpt::obs::CObservation& observation) {
    named.scan.t_ns = needed_time_of(observation);
    if (motion_) {
      motion_->t_ns = named.scan.t_ns;
      recording_.events.emplace_back(*motion_);
      motion_.reset();
    }
    std::vector<core::Label> labels(named.scan.observations.size(), core::no_label);
    std::copy_n(named.identities.begin(), std::min(labels.size(), named.identities.size()), labels.begin());
    recording_.labels.push_back(std::move(labels));
    recording_.events.emplace_back(std::move(named.scan));
  }

  MapBuilderOptions options_;
  core::Recording recording_;
  std::optional<core::Odometry> motion_;  ///< since the last scan
  std::optional<mrpt::poses::CPose2D> last_reading_;
};

}  // namespace

logs::AcfrSettings vehicle_for(const std::string& detector) {
  return detector == "reflectors" ? logs::car_park_settings() : logs::AcfrSettings{};
}

RawlogEntries read_entries(const std::string& path) {
  RawlogStream stream(path);
  RawlogEntries entries;
  while (auto entry = stream.next()) entries.push_back(std::move(entry));
  if (!stream.damage().empty()) throw core::InputError(stream.damage());
  return entries;
}

void add_true_positions(const RawlogEntries& entries, const MapBuilderOptions& options, core::Recording& recording) {
  Fixes fixes(options, recording);
  for (const auto& entry : entries) {
    if (const auto* frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(entry.get())) {
      for (const auto& observation : *frame) fixes.take(*observation);
    } else if (const auto* observation = dynamic_cast<const mrpt::obs::CObservation*>(entry.get())) {
      fixes.take(*observation);
    }
  }
}

core::Recording read_rawlog(const std::string& path, const MapBuilderOptions& options) {
  const RawlogEntries entries = with_movements(read_entries(path), vehicle_for(options.detector));
  Recorder recorder(std::filesystem::path(path).stem().string(), options);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    try {
      recorder.take(*entries[i]);
    } catch (const core::InputError& error) {
      throw core::InputError(path + ": entry " + std::to_string(i) + ": " + error.what());
    }
  }
  core::Recording recording = recorder.finish();
  add_true_positions(entries, options, recording);
  return recording;
}

}  // namespace helixnav::apps
