// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog/observations_only.hpp"

#include <optional>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "helixnav/core/odometry.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"
#include "rawlog/rawlog_sink.hpp"
#include "reading/read_rawlog.hpp"

namespace helixnav::apps {
namespace {

class Unroller {
 public:
  explicit Unroller(const std::string& out) : sink_(out) {}

  void take(const mrpt::serialization::CSerializable& entry) {
    if (const auto* actions = dynamic_cast<const mrpt::obs::CActionCollection*>(&entry)) {
      if (const auto moved = mrpt_adapter::odometry_of(*actions)) pose_ = core::compose(pose_, moved->T_before_after);
      return;
    }
    if (const auto* frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(&entry)) {
      if (!frame->empty()) write_odometer((*frame->begin())->timestamp);
      for (const auto& observation : *frame) sink_.write(*observation);
      return;
    }
    sink_.write(entry);
  }

  std::size_t finish() {
    sink_.finish();
    return sink_.entries();
  }

 private:
  void write_odometer(const mrpt::Clock::time_point& time) {
    mrpt::obs::CObservationOdometry odometer;
    odometer.timestamp = time;
    odometer.sensorLabel = "ODOMETRY";
    odometer.odometry = {pose_.x_m, pose_.y_m, pose_.heading_rad};
    sink_.write(odometer);
  }

  RawlogSink sink_;
  core::Pose2 pose_;
};

}  // namespace

std::size_t write_observations_only(const std::string& in, const std::string& out) {
  Unroller unroller(out);
  for (const auto& entry : read_entries(in)) unroller.take(*entry);
  return unroller.finish();
}

}  // namespace helixnav::apps
