// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "helixnav/core/recording.hpp"

namespace helixnav::sim::testing {

template <class T>
std::vector<T> events_of(const core::Recording& run) {
  std::vector<T> found;
  for (const core::Event& event : run.events) {
    if (const T* e = std::get_if<T>(&event)) found.push_back(*e);
  }
  return found;
}

/// Every number of a part of a recording, as bytes: equal strings, equal bits.
class Bytes {
 public:
  template <class T, std::enable_if_t<std::is_arithmetic_v<T>, int> = 0>
  void add(const T& value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    text_.append(raw, sizeof(T));
  }
  template <class Derived>
  void add(const Eigen::MatrixBase<Derived>& matrix) {
    for (const double x : matrix.reshaped()) add(x);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

inline std::string odometry_bytes(const core::Recording& run) {
  Bytes bytes;
  for (const core::Odometry& odometry : events_of<core::Odometry>(run)) {
    bytes.add(odometry.t_ns);
    bytes.add(odometry.T_before_after.vector());
    bytes.add(odometry.covariance);
  }
  return bytes.text();
}

inline std::string scan_bytes(const core::Recording& run) {
  Bytes bytes;
  const std::vector<core::Scan> scans = events_of<core::Scan>(run);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    bytes.add(scans[i].t_ns);
    for (std::size_t j = 0; j < scans[i].observations.size(); ++j) {
      bytes.add(scans[i].observations[j].z);
      bytes.add(scans[i].observations[j].R);
      bytes.add(run.labels.at(i).at(j));
    }
  }
  return bytes.text();
}

inline std::string truth_bytes(const core::Recording& run) {
  Bytes bytes;
  for (const core::TruePose& pose : run.true_poses) {
    bytes.add(pose.t_ns);
    bytes.add(pose.T_world_robot.vector());
  }
  for (const core::TrueLandmark& landmark : run.true_landmarks) {
    bytes.add(landmark.label);
    bytes.add(landmark.point_m);
  }
  return bytes.text();
}

}  // namespace helixnav::sim::testing
