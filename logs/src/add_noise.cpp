// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/add_noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::logs {
namespace {

using core::ObservationKind;

/// One number of the log with its variance.
struct Number {
  double* value = nullptr;
  double* variance = nullptr;
};

/// Row of the field in an observation's z, −1 when it has none.
int row_of(NoiseField field, ObservationKind kind) {
  switch (field) {
    case NoiseField::point_x:
      return kind == ObservationKind::cartesian ? 0 : -1;
    case NoiseField::point_y:
      return kind == ObservationKind::cartesian ? 1 : -1;
    case NoiseField::range:
      return kind == ObservationKind::range_bearing || kind == ObservationKind::range ? 0 : -1;
    case NoiseField::bearing:
      if (kind == ObservationKind::range_bearing) return 1;
      return kind == ObservationKind::bearing ? 0 : -1;
    default:
      return -1;
  }
}

Number odometry_number(NoiseField field, core::Odometry& odometry) {
  switch (field) {
    case NoiseField::odometry_x:
      return {&odometry.T_before_after.x_m, &odometry.covariance(0, 0)};
    case NoiseField::odometry_y:
      return {&odometry.T_before_after.y_m, &odometry.covariance(1, 1)};
    case NoiseField::odometry_heading:
      return {&odometry.T_before_after.heading_rad, &odometry.covariance(2, 2)};
    default:
      return {};
  }
}

/// All numbers of the field, in the order of the log.
std::vector<Number> numbers_of(NoiseField field, core::Recording& recording) {
  std::vector<Number> numbers;
  for (core::Event& event : recording.events) {
    if (auto* odometry = std::get_if<core::Odometry>(&event)) {
      const Number number = odometry_number(field, *odometry);
      if (number.value != nullptr) numbers.push_back(number);
    }
    auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    for (core::Observation& observation : scan->observations) {
      const int row = row_of(field, observation.kind);
      if (row >= 0) numbers.push_back({&observation.z[row], &observation.R(row, row)});
    }
  }
  return numbers;
}

bool is_angle(NoiseField field) { return field == NoiseField::odometry_heading || field == NoiseField::bearing; }

void check(const core::Recording& recording, const std::vector<Noise>& noises) {
  std::vector<NoiseField> named;
  for (const Noise& noise : noises) {
    if (!(noise.sigma > 0.0) || !std::isfinite(noise.sigma)) {
      throw core::InputError("noise on " + name_of(noise.field) + ": expected a standard deviation above 0");
    }
    if (std::find(named.begin(), named.end(), noise.field) != named.end()) {
      throw core::InputError("noise on " + name_of(noise.field) + " is asked for twice");
    }
    named.push_back(noise.field);
  }
  if (recording.events.empty()) throw core::InputError(recording.name + ": a log without events takes no noise");
}

AddedNoise add(core::Recording& recording, const Noise& noise, std::uint64_t seed) {
  const std::vector<Number> numbers = numbers_of(noise.field, recording);
  if (numbers.empty()) {
    throw core::InputError(recording.name + ": noise on " + name_of(noise.field) + ": this log has no such numbers");
  }
  core::RandomStream stream(seed, "noise on " + name_of(noise.field));
  double sum = 0.0;
  for (const Number& number : numbers) {
    const double drawn = stream.normal(0.0, noise.sigma);
    sum += drawn * drawn;
    *number.value += drawn;
    if (is_angle(noise.field)) *number.value = core::wrap_to_pi(*number.value);
    *number.variance += noise.sigma * noise.sigma;
    if (noise.field == NoiseField::range && !(*number.value > 0.0)) {
      throw core::InputError(recording.name + ": noise on range_m makes a range negative; choose a smaller sigma");
    }
  }
  const auto count = static_cast<double>(numbers.size());
  const auto bound = [&](double probability) {
    return noise.sigma * std::sqrt(core::chi2_quantile(probability, static_cast<int>(numbers.size())) / count);
  };
  return {noise.field, noise.sigma, numbers.size(), std::sqrt(sum / count), bound(0.005), bound(0.995)};
}

}  // namespace

std::string name_of(NoiseField field) {
  switch (field) {
    case NoiseField::odometry_x:
      return "odometry_x_m";
    case NoiseField::odometry_y:
      return "odometry_y_m";
    case NoiseField::odometry_heading:
      return "odometry_heading_rad";
    case NoiseField::point_x:
      return "point_x_m";
    case NoiseField::point_y:
      return "point_y_m";
    case NoiseField::range:
      return "range_m";
    case NoiseField::bearing:
      return "bearing_rad";
  }
  return "unknown";
}

std::vector<NoiseField> noise_fields() {
  return {NoiseField::odometry_x, NoiseField::odometry_y, NoiseField::odometry_heading, NoiseField::point_x,
          NoiseField::point_y,    NoiseField::range,      NoiseField::bearing};
}

std::vector<AddedNoise> add_noise(core::Recording& recording, const std::vector<Noise>& noises, std::uint64_t seed) {
  check(recording, noises);
  core::Recording changed = recording;
  std::vector<AddedNoise> added;
  added.reserve(noises.size());
  for (const Noise& noise : noises) added.push_back(add(changed, noise, seed));
  recording = std::move(changed);
  return added;
}

}  // namespace helixnav::logs
