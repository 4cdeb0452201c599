// SPDX-License-Identifier: BSD-3-Clause
#include "roads.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/angle.hpp"

namespace helixnav::sim {
namespace {

using core::pi;

constexpr double point_spacing_m = 0.5;
constexpr int least_points_per_lap = 720;

int points_per_lap(double lap_length_m) {
  return std::max(least_points_per_lap, static_cast<int>(std::ceil(lap_length_m / point_spacing_m)));
}

/// Samples a curve of period 2π and scales its first lap to the desired length.
template <class Curve>
Polyline sample_and_scale(const Curve& curve, double lap_length_m, int laps) {
  const int per_lap = points_per_lap(lap_length_m);
  Polyline points;
  for (int i = 0; i <= laps * per_lap; ++i) points.push_back(curve(2.0 * pi * i / per_lap));
  double raw_length = 0.0;
  for (int i = 0; i < per_lap; ++i) {
    raw_length += (points[static_cast<std::size_t>(i) + 1] - points[static_cast<std::size_t>(i)]).norm();
  }
  for (Eigen::Vector2d& point : points) point *= lap_length_m / raw_length;
  return points;
}

/// Radius by angle: a circle with waves of two and three periods.
struct Waves {
  double amplitude_two;
  double amplitude_three;
  double phase_two_rad;
  double phase_three_rad;

  explicit Waves(core::RandomStream& random)
      : amplitude_two(random.uniform(0.05, 0.16)),
        amplitude_three(random.uniform(0.05, 0.16)),
        phase_two_rad(random.uniform(0.0, 2.0 * pi)),
        phase_three_rad(random.uniform(0.0, 2.0 * pi)) {}

  double radius(double angle_rad) const {
    return 1.0 + amplitude_two * std::cos(2.0 * angle_rad + phase_two_rad) +
           amplitude_three * std::cos(3.0 * angle_rad + phase_three_rad);
  }
};

Eigen::Vector2d on_ray(double radius, double angle_rad) {
  return radius * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

double smooth_step(double share) {
  const double u = std::clamp(share, 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

/// Point of a racetrack whose first straight begins at the origin along x.
Eigen::Vector2d racetrack_point(double along_m, double straight_m, double radius_m) {
  const double turn_m = pi * radius_m;
  const double half_m = straight_m + turn_m;
  const bool back = along_m >= half_m;
  const double s = back ? along_m - half_m : along_m;
  Eigen::Vector2d point(std::min(s, straight_m), 0.0);
  if (s > straight_m) {
    const double angle_rad = (s - straight_m) / radius_m;
    point += radius_m * Eigen::Vector2d(std::sin(angle_rad), 1.0 - std::cos(angle_rad));
  }
  // The second half is the first one turned by half a turn about the middle.
  return back ? Eigen::Vector2d(straight_m - point.x(), 2.0 * radius_m - point.y()) : point;
}

}  // namespace

Polyline wavy_loop(double lap_length_m, int laps, core::RandomStream& random) {
  const Waves waves(random);
  return sample_and_scale([&](double t) { return on_ray(waves.radius(t), t); }, lap_length_m, laps);
}

Polyline spiral(double lap_length_m, double offset_m, int laps, core::RandomStream& random) {
  Polyline points = wavy_loop(lap_length_m, laps, random);
  const int per_lap = points_per_lap(lap_length_m);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double lap = static_cast<double>(i) / per_lap;
    points[i] += offset_m * smooth_step((lap - 0.65) / 0.3) * points[i].normalized();
  }
  return points;
}

Polyline figure_of_eight(double lap_length_m, int laps, core::RandomStream& random) {
  const double slimness = random.uniform(0.7, 1.0);
  const auto curve = [&](double t) { return Eigen::Vector2d(std::sin(t), slimness * std::sin(t) * std::cos(t)); };
  return sample_and_scale(curve, lap_length_m, laps);
}

Polyline circle(double lap_length_m, int laps) {
  return sample_and_scale([](double t) { return on_ray(1.0, t); }, lap_length_m, laps);
}

Polyline racetrack(double lap_length_m, double turn_radius_m, double run_up_m, int laps) {
  const double straight_m = lap_length_m / 2.0 - pi * turn_radius_m;
  const int per_lap = points_per_lap(lap_length_m);
  Polyline points;
  for (int i = 0; i <= laps * per_lap; ++i) {
    const double along_m = std::fmod(run_up_m + lap_length_m * i / per_lap, lap_length_m);
    points.push_back(racetrack_point(along_m, straight_m, turn_radius_m));
  }
  return points;
}

}  // namespace helixnav::sim
