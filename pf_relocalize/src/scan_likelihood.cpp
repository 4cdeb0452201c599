// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/scan_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "helixnav/core/errors.hpp"
#include "scan_likelihood_impl.hpp"

namespace helixnav::pf_relocalize {
namespace {

/// Products of this many factors 1 + Σ stay far inside the range of a double: one logarithm for all of them.
constexpr std::size_t factors_a_logarithm = 8;

double area_m2(const core::FieldOfView& view) {
  const double area = 0.5 * (view.max_bearing_rad - view.min_bearing_rad) *
                      (view.max_range_m * view.max_range_m - view.min_range_m * view.min_range_m);
  if (!(area > 0.0) || !std::isfinite(area)) {
    throw core::PreconditionError("scan likelihood: the field of view must be bounded in range and not empty");
  }
  return area;
}

void append_robot_point(const core::Observation& observation, const core::Pose2& T_robot_sensor,
                        std::vector<RobotPoint>& points) {
  const core::LocatedLandmark located = core::locate_landmark(observation, core::Pose2(), T_robot_sensor);
  points.push_back({located.point_world_m, located.G_z * observation.R * located.G_z.transpose()});
}

}  // namespace

std::vector<RobotPoint> robot_points(const core::Scan& scan) {
  std::vector<RobotPoint> points;
  for (const core::Observation& observation : scan.observations) {
    append_robot_point(observation, scan.T_robot_sensor, points);
  }
  return points;
}

ScanLikelihood::ScanLikelihood(const ReferenceMap& map, const SensorModel& sensor) {
  if (!(sensor.detection_probability > 0.0 && sensor.detection_probability < 1.0) ||
      !(sensor.extraneous_per_scan > 0.0)) {
    throw core::PreconditionError(
        "sensor model: detection_probability must lie in (0, 1), extraneous_per_scan above 0, "
        "got " +
        std::to_string(sensor.detection_probability) + " and " + std::to_string(sensor.extraneous_per_scan));
  }
  impl_ = std::make_unique<Impl>(map, sensor);
  impl_->points.reserve(64);
}

ScanLikelihood::~ScanLikelihood() = default;
ScanLikelihood::ScanLikelihood(ScanLikelihood&&) noexcept = default;
ScanLikelihood& ScanLikelihood::operator=(ScanLikelihood&&) noexcept = default;

void ScanLikelihood::set_scan(const core::Scan& scan) {
  const double extraneous_per_m2 = impl_->sensor.extraneous_per_scan / area_m2(scan.field_of_view);
  impl_->points.clear();
  for (const core::Observation& observation : scan.observations) {
    append_robot_point(observation, scan.T_robot_sensor, impl_->points);
  }
  impl_->density_ratio_m2 = impl_->sensor.detection_probability / extraneous_per_m2;
  impl_->sector = view_sector(scan.field_of_view, scan.T_robot_sensor);
  impl_->view_reach_m = scan.field_of_view.max_range_m + scan.T_robot_sensor.position_m().norm();
  impl_->with_visibility = true;
}

void ScanLikelihood::set_points(const std::vector<RobotPoint>& points, double extraneous_per_m2) {
  impl_->points = points;
  impl_->density_ratio_m2 = impl_->sensor.detection_probability / extraneous_per_m2;
  impl_->with_visibility = false;
}

void ScanLikelihood::Impl::subtract_expected(ParticleTile& tile, double* out) const {
  TileArray count{};
  const Box box(tile.poses.x, tile.poses.y, tile.poses.n);
  const double reach_m = view_reach_m + table.latent_reach_m;
  const Eigen::Vector2d reach(reach_m, reach_m);
  table.grid.visit(box.low - reach, box.high + reach, [&](std::uint32_t i) {
    if (box.squared_distance(table.x[i], table.y[i]) > reach_m * reach_m) return;
    count_visible(tile.poses, sector, tile.landmark(i), count.data());
  });
  for (std::size_t p = 0; p < tile.poses.n; ++p) out[p] -= sensor.detection_probability * count[p];
}

void ScanLikelihood::Impl::evaluate_tile(ParticleTile& tile, double* out) const {
  const std::size_t n = tile.poses.n;
  TileArray ratio, product, sum;
  ratio.fill(density_ratio_m2);
  std::fill_n(out, n, 0.0);
  for (std::size_t first = 0; first < points.size(); first += factors_a_logarithm) {
    product.fill(1.0);
    for (std::size_t j = first; j < std::min(first + factors_a_logarithm, points.size()); ++j) {
      sum.fill(1.0);
      add_point_densities(
          tile, points[j], [&](std::uint32_t) { return ratio.data(); }, sum.data());
      for (std::size_t p = 0; p < n; ++p) product[p] *= sum[p];
    }
    for (std::size_t p = 0; p < n; ++p) out[p] += std::log(product[p]);
  }
  if (with_visibility) subtract_expected(tile, out);
}

void ScanLikelihood::evaluate(const Particles& particles, std::size_t begin, std::size_t end, double* out) const {
  for (std::size_t first = begin; first < end; first += tile_size) {
    ParticleTile tile(impl_->table, particles, first, std::min(first + tile_size, end));
    impl_->evaluate_tile(tile, out + (first - begin));
  }
}

}  // namespace helixnav::pf_relocalize
