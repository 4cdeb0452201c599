// SPDX-License-Identifier: BSD-3-Clause
#include "sensors_apart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "lasting_matches.hpp"

namespace helixnav::apps {
namespace {

constexpr std::size_t scans_a_stretch = 50;
constexpr std::size_t least_stretches = 8;
constexpr int least_pairs = 5;  // of each sensor in a stretch

/// Residuals of range and bearing.
struct Residuals {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
};

/// [mounting] residuals of a stretch; mountings are told apart exactly.
using Key = std::array<double, 3>;
using Stretch = std::map<Key, Residuals>;

std::vector<Stretch> stretches_of(const core::Recording& recording, const runs::Run& run) {
  std::vector<Stretch> stretches;
  for (const LastingMatch& match : lasting_matches(recording, run)) {
    stretches.resize(std::max(stretches.size(), match.scan / scans_a_stretch + 1));
    const core::Pose2& mounting = match.T_robot_sensor;
    Residuals& sums = stretches.back()[{mounting.x_m, mounting.y_m, mounting.heading_rad}];
    sums.sum += match.residual;
    ++sums.count;
  }
  return stretches;
}

struct Mean {
  double value = 0.0, sigma = 0.0;
};

/// Of independent values, with the sigma of the mean by their scatter.
Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Mean mean;
  for (const double value : values) mean.value += value / n;
  for (const double value : values) mean.sigma += std::pow(value - mean.value, 2);
  mean.sigma = std::sqrt(mean.sigma / (n * (n - 1.0)));
  return mean;
}

std::optional<SensorsApart> compare(const std::vector<Stretch>& stretches, const Key& one, const Key& other) {
  std::vector<double> farther_m, left_rad;
  for (const Stretch& stretch : stretches) {
    const auto a = stretch.find(one);
    const auto b = stretch.find(other);
    if (a == stretch.end() || b == stretch.end()) continue;
    if (a->second.count < least_pairs || b->second.count < least_pairs) continue;
    const Eigen::Vector2d apart = a->second.sum / a->second.count - b->second.sum / b->second.count;
    farther_m.push_back(apart.x());
    left_rad.push_back(apart.y());
  }
  if (farther_m.size() < least_stretches) return std::nullopt;
  const Mean farther = mean_of(farther_m);
  const Mean left = mean_of(left_rad);
  return SensorsApart{
      {one[0], one[1], one[2]}, {other[0], other[1], other[2]}, farther.value, farther.sigma, left.value, left.sigma};
}

double sigmas(const SensorsApart& apart) {
  const auto of = [](double value, double sigma) { return sigma > 0.0 ? std::abs(value) / sigma : 0.0; };
  return std::max(of(apart.farther_m, apart.farther_sigma_m), of(apart.left_rad, apart.left_sigma_rad));
}

}  // namespace

std::optional<SensorsApart> sensors_apart_of(const core::Recording& recording, const runs::Run& run) {
  const std::vector<Stretch> stretches = stretches_of(recording, run);
  std::map<Key, int> sensors;
  for (const Stretch& stretch : stretches) {
    for (const auto& [key, residuals] : stretch) sensors[key] += residuals.count;
  }
  std::optional<SensorsApart> most;
  for (auto one = sensors.begin(); one != sensors.end(); ++one) {
    for (auto other = sensors.begin(); other != one; ++other) {
      const auto apart = compare(stretches, one->first, other->first);
      if (apart && (!most || sigmas(*apart) > sigmas(*most))) most = apart;
    }
  }
  return most;
}

bool surely_apart(const SensorsApart& apart) {
  constexpr double surely = 6.0;  // at most 5.1 of 38 drives whose sensors agreed, 6.0 to 27 of most that did not
  return sigmas(apart) > surely;
}

}  // namespace helixnav::apps
