// SPDX-License-Identifier: BSD-3-Clause
#include "movers.hpp"

#include <cmath>

#include "in_view.hpp"

namespace helixnav::sim {
namespace {

constexpr Interval footpath_m{2.0, 4.0};  // from the middle of the road, on either side
constexpr double other_lane_m = 3.0;      // to the left, oncoming and overtaking: nothing drives through the vehicle

}  // namespace

Movers::Movers(const Scenario& scenario, const Route& road, const std::vector<DriveStep>& steps, std::uint64_t seed)
    : road_(road) {
  if (scenario.movers.in_view <= 0.0 || steps.empty()) return;
  core::RandomStream random(seed, "sim.movers");
  const double scans = static_cast<double>(steps.size()) / scenario.vehicle.samples_per_scan;
  double left = scenario.movers.in_view * scans;
  const std::size_t most = 1000 + 100 * static_cast<std::size_t>(left);  // for a view that is always empty
  for (std::size_t tries = 0; left > 0.0 && tries < most; ++tries) {
    const Mover mover =
        draw(scenario.movers, scenario.scanner.field_of_view, steps, scenario.vehicle.odometry_period_s, random);
    const double seen = scans_in_view(mover, scenario, steps);
    if (seen == 0.0) continue;
    left -= seen;
    movers_.push_back(mover);
  }
}

std::vector<Eigen::Vector2d> Movers::at(double t_s) const {
  std::vector<Eigen::Vector2d> points_m;
  for (const Mover& mover : movers_) {
    if (is_on_road(mover, t_s)) points_m.push_back(place_m(mover, t_s));
  }
  return points_m;
}

Movers::Mover Movers::draw(const MoverOptions& options, const core::FieldOfView& view,
                           const std::vector<DriveStep>& steps, double period_s, core::RandomStream& random) const {
  const auto step = static_cast<std::size_t>(random.below(steps.size()));
  const bool drives = random.bernoulli(options.car_share);
  const Interval& speed_mps = drives ? options.driving_mps : options.walking_mps;
  Mover mover;
  mover.met_s = static_cast<double>(step + 1) * period_s;
  mover.met_at_m = steps[step].along_m + random.uniform(-view.max_range_m, view.max_range_m);
  mover.speed_mps = random.uniform(speed_mps.min, speed_mps.max) * (random.bernoulli(0.5) ? 1.0 : -1.0);
  const double beside_m = random.uniform(footpath_m.min, footpath_m.max) * (random.bernoulli(0.5) ? 1.0 : -1.0);
  mover.to_left_m = drives ? other_lane_m : beside_m;
  return mover;
}

bool Movers::is_on_road(const Mover& mover, double t_s) const {
  const double along_m = mover.met_at_m + mover.speed_mps * (t_s - mover.met_s);
  return along_m > 0.0 && along_m < road_.length_m();
}

Eigen::Vector2d Movers::place_m(const Mover& mover, double t_s) const {
  const double along_m = mover.met_at_m + mover.speed_mps * (t_s - mover.met_s);
  const Eigen::Vector2d forward = road_.direction(along_m);
  return road_.at(along_m) + mover.to_left_m * Eigen::Vector2d(-forward.y(), forward.x());
}

double Movers::scans_in_view(const Mover& mover, const Scenario& scenario, const std::vector<DriveStep>& steps) const {
  const auto stride = static_cast<std::size_t>(scenario.vehicle.samples_per_scan);
  double scans = 0.0;
  for (std::size_t i = stride; i <= steps.size(); i += stride) {
    const double t_s = static_cast<double>(i) * scenario.vehicle.odometry_period_s;
    if (!is_on_road(mover, t_s)) continue;
    const core::Pose2 T_world_sensor = core::compose(steps[i - 1].T_world_robot, scenario.scanner.T_robot_sensor);
    const Polar seen = polar(core::inverse(T_world_sensor), place_m(mover, t_s));
    scans += contains(scenario.scanner.field_of_view, seen) ? 1.0 : 0.0;
  }
  return scans;
}

}  // namespace helixnav::sim
