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
    throw core::PreconditionError("sensor model: detection_probability must lie in (0, 1), extraneous_per_scan above 0, "
                                  "got " + std::to_string(sensor.detection_probability) + " and " +
                                  std::to_string(sensor.extraneous_per_scan));
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
  impl_->with_visibility = true;
}

void ScanLikelihood::set_points(const std::vector<RobotPoint>& points, double extraneous_per_m2) {
  impl_->points = points;
  impl_->density_ratio_m2 = impl_->sensor.detection_probability / extraneous_per_m2;
  impl_->with_visibility = false;
}

void ScanLikelihood::Impl::subtract_expected(const ParticleBlock& block, double* out) const {
  BlockArray count{}, shift_x, shift_y;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.modes == 0) {
      count_visible(block.poses, sector, table.x[i], table.y[i], nullptr, nullptr, count.data());
      continue;
    }
    for (std::size_t p = 0; p < block.poses.n; ++p) {
      const Eigen::Vector2d shift = block.displacement(table, i, p);
      shift_x[p] = shift.x();
      shift_y[p] = shift.y();
    }
    count_visible(block.poses, sector, table.x[i], table.y[i], shift_x.data(), shift_y.data(), count.data());
  }
  for (std::size_t p = 0; p < block.poses.n; ++p) out[p] -= sensor.detection_probability * count[p];
}

void ScanLikelihood::Impl::evaluate_block(const ParticleBlock& block, double* out) const {
  PairWorkspace work;
  BlockArray product, sum;
  std::fill_n(out, block.poses.n, 0.0);
  for (std::size_t first = 0; first < points.size(); first += factors_a_logarithm) {
    std::fill_n(product.begin(), block.poses.n, 1.0);
    for (std::size_t j = first; j < std::min(first + factors_a_logarithm, points.size()); ++j) {
      std::fill_n(sum.begin(), block.poses.n, 1.0);
      add_pair_densities(table, block, points[j], work,
                         [&](std::size_t, std::uint32_t) { return density_ratio_m2; }, sum.data());
      for (std::size_t p = 0; p < block.poses.n; ++p) product[p] *= sum[p];
    }
    for (std::size_t p = 0; p < block.poses.n; ++p) out[p] += std::log(product[p]);
  }
  if (with_visibility) subtract_expected(block, out);
}

void ScanLikelihood::evaluate(const Particles& particles, std::size_t begin, std::size_t end, double* out) const {
  for (std::size_t first = begin; first < end; first += block_size) {
    const ParticleBlock block(particles, first, std::min(first + block_size, end));
    impl_->evaluate_block(block, out + (first - begin));
  }
}

std::size_t ScanLikelihood::pairs_within_reach(const Particles& particles) const {
  std::size_t pairs = 0;
  PairWorkspace work;
  BlockArray sum{};
  for (std::size_t first = 0; first < particles.size(); first += block_size) {
    const ParticleBlock block(particles, first, std::min(first + block_size, particles.size()));
    for (const RobotPoint& point : impl_->points) {
      add_pair_densities(impl_->table, block, point, work,
                         [&](std::size_t, std::uint32_t) { return static_cast<double>(++pairs); }, sum.data());
    }
  }
  return pairs;
}

}  // namespace helixnav::pf_relocalize
