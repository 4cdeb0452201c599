// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/system/CTimeLogger.h>

#include "convert_frame.hpp"
#include "estimator.hpp"
#include "helixnav/mrpt_adapter/map_builder.hpp"
#include "helixnav/mrpt_adapter/run_access.hpp"

namespace helixnav::mrpt_adapter {

/// The state of a builder. Callers hold the lock.
class MapBuilder::Impl {
 public:
  using Lock = std::lock_guard<std::mutex>;

  Impl(const MapBuilderOptions& options, const mrpt::system::COutputLogger& log, std::mutex& lock);

  void start_at(const core::PoseGaussian& start);

  // earlier_map.cpp
  void go_on_in(const core::JointMap& earlier, const std::optional<core::PoseGaussian>& pose);
  void set_pose(const core::PoseGaussian& pose);
  void lose();
  core::JointMap joint_map() const;

  /// One frame, the observations of one instant; `motion` as its actions say.
  void feed(const std::optional<core::Odometry>& motion, const mrpt::obs::CSensoryFrame& frame, bool stream);

  std::int64_t number_of(core::LandmarkId landmark) const;  ///< the name where association is known

  const mrpt::maps::CMultiMetricMap& metric_map();

  const MapBuilderOptions options;
  std::mutex& lock;
  mrpt::system::CTimeLogger profiler;
  std::unique_ptr<Estimator> navigator;
  mrpt::maps::CSimpleMap simple_map;
  std::vector<core::Pose2> path;         ///< after each step
  std::vector<Step> steps;               ///< of the last feed
  std::optional<core::StepReport> last;  ///< the last step of all
  std::vector<std::size_t> last_measurements;

 private:
  /// How landmarks are told apart, settled by the first measurements.
  enum class Association { open, by_name, unknown };

  void restart(std::unique_ptr<Estimator> estimator);
  void see(NamedScan scan, bool stream);
  core::StepReport observe(const NamedScan& scan);
  void remember(const NamedScan& scan, const core::StepReport& report);
  void tell(const core::StepReport& report) const;
  void warn(const std::string& text);
  void keep(const mrpt::obs::CSensoryFrame& frame);
  void place_path(const core::StepReport& report);

  const mrpt::system::COutputLogger& log_;
  MotionState motion_;
  bool motion_is_known_ = false;  ///< an action or a reading of odometry has come, ever
  Association association_ = Association::open;
  std::map<core::LandmarkId, std::int64_t> name_of_;
  std::map<core::LandmarkId, core::Nanoseconds> seen_ns_;
  std::set<std::string> warned_;
  mrpt::maps::CMultiMetricMap metric_map_;
  bool metric_map_is_current_ = false;
  std::size_t part_begin_ = 0;  ///< on the path, where the vehicle was lost or began anywhere
  double reach_m_ = 0.0;        ///< of the sensor, as the last observation states it
};

}  // namespace helixnav::mrpt_adapter
