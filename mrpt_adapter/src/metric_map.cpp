// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/maps/CLandmarksMap.h>

#include "map_builder_impl.hpp"

namespace helixnav::mrpt_adapter {
namespace {

mrpt::system::TTimeStamp time_stamp(core::Nanoseconds t_ns) {
  constexpr std::int64_t ticks_1601_to_1970 = 116'444'736'000'000'000;
  return mrpt::system::TTimeStamp(mrpt::Clock::duration(t_ns / 100 + ticks_1601_to_1970));
}

mrpt::maps::CLandmark landmark_of(const core::MapLandmark& ours, std::int64_t number) {
  mrpt::maps::CLandmark landmark;
  landmark.ID = number;
  landmark.pose_mean = {ours.point.mean_m.x(), ours.point.mean_m.y(), 0.0};
  landmark.pose_cov_11 = static_cast<float>(ours.point.covariance_m2(0, 0));
  landmark.pose_cov_22 = static_cast<float>(ours.point.covariance_m2(1, 1));
  landmark.pose_cov_12 = static_cast<float>(ours.point.covariance_m2(0, 1));
  landmark.seenTimesCount = static_cast<std::uint32_t>(ours.observations);
  landmark.createOneFeature();
  landmark.features[0].type = mrpt::vision::featBeacon;
  landmark.features[0].keypoint.ID = static_cast<mrpt::vision::TFeatureID>(number);
  return landmark;
}

}  // namespace

std::int64_t MapBuilder::Impl::number_of(core::LandmarkId landmark) const {
  const auto named = name_of_.find(landmark);
  return named == name_of_.end() ? landmark : named->second;
}

const mrpt::maps::CMultiMetricMap& MapBuilder::Impl::metric_map() {
  if (metric_map_is_current_) return metric_map_;
  const mrpt::system::CTimeLoggerEntry refresh(profiler, "refresh_map");
  auto landmarks = mrpt::maps::CLandmarksMap::Create();
  for (const core::MapLandmark& ours : navigator->map()) {
    if (ours.state != core::LandmarkState::mature) continue;
    mrpt::maps::CLandmark landmark = landmark_of(ours, number_of(ours.id));
    const auto seen = seen_ns_.find(ours.id);
    if (seen != seen_ns_.end()) landmark.timestampLastSeen = time_stamp(seen->second);
    landmarks->landmarks.push_back(landmark);
  }
  metric_map_.maps.clear();
  metric_map_.maps.push_back(landmarks);
  metric_map_is_current_ = true;
  return metric_map_;
}

}  // namespace helixnav::mrpt_adapter
