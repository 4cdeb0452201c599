// SPDX-License-Identifier: BSD-3-Clause
#include "kernels.hpp"

#include <cmath>
#include <cstring>

#include "clones.hpp"

namespace helixnav::pf_relocalize {
namespace {

constexpr TileArray no_shift{};

/// e^x for x ≤ 0 in a form that vectorises: 2^k by exponent bits times a Taylor polynomial on |r| ≤ ln2/2.
/// Relative error below 1e-11; below −600 the value at −600.
inline double exp_of_negative(double x) {
  constexpr double log2_e = 1.4426950408889634074, ln2_high = 6.93147180369123816490e-01,
                   ln2_low = 1.90821492927058770002e-10, shifter = 6755399441055744.0;  // 1.5·2^52
  const double clamped = x < -600.0 ? -600.0 : x;
  const double shifted = clamped * log2_e + shifter;
  const double k = shifted - shifter;
  const double r = (clamped - k * ln2_high) - k * ln2_low;
  double p = 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  p = p * r + 1.0;
  p = p * r + 1.0;
  std::uint64_t exponent = 0, bits = 0;
  std::memcpy(&exponent, &shifted, sizeof exponent);
  std::memcpy(&bits, &p, sizeof bits);
  bits += exponent << 52;
  std::memcpy(&p, &bits, sizeof p);
  return p;
}

}  // namespace

HELIXNAV_CLONES void place_points(const PoseTile& poses, const RobotPoint& point, PlacedPoints& placed) {
  const double bx = point.mean_m.x(), by = point.mean_m.y();
  const double bxx = point.covariance_m2(0, 0), bxy = point.covariance_m2(0, 1), byy = point.covariance_m2(1, 1);
  for (std::size_t i = 0; i < poses.n; ++i) {
    const double c = poses.cos_heading[i], s = poses.sin_heading[i];
    const double cc = c * c, ss = s * s, cs = c * s;
    placed.x[i] = poses.x[i] + c * bx - s * by;
    placed.y[i] = poses.y[i] + s * bx + c * by;
    placed.sxx[i] = cc * bxx - 2.0 * cs * bxy + ss * byy;
    placed.syy[i] = ss * bxx + 2.0 * cs * bxy + cc * byy;
    placed.sxy[i] = cs * (bxx - byy) + (cc - ss) * bxy;
  }
}

HELIXNAV_CLONES void add_densities(std::size_t n, const PlacedPoints& placed, const TileLandmark& landmark,
                                   const double* factor, double* sum) {
  constexpr double inverse_two_pi = 0.15915494309189533577;
  const double* shift_x = landmark.shift_x != nullptr ? landmark.shift_x : no_shift.data();
  const double* shift_y = landmark.shift_y != nullptr ? landmark.shift_y : no_shift.data();
  for (std::size_t p = 0; p < n; ++p) {
    const double dx = landmark.x + shift_x[p] - placed.x[p], dy = landmark.y + shift_y[p] - placed.y[p];
    const double sxx = landmark.sxx + placed.sxx[p], sxy = landmark.sxy + placed.sxy[p];
    const double syy = landmark.syy + placed.syy[p];
    const double information = 1.0 / (sxx * syy - sxy * sxy);
    const double d2 = (dx * (dx * syy - 2.0 * dy * sxy) + dy * dy * sxx) * information;
    sum[p] += inverse_two_pi * factor[p] * std::sqrt(information) * exp_of_negative(-0.5 * d2);
  }
}

HELIXNAV_CLONES void count_visible(const PoseTile& poses, const ViewSector& sector, const TileLandmark& landmark,
                                   double* count) {
  const double* shift_x = landmark.shift_x != nullptr ? landmark.shift_x : no_shift.data();
  const double* shift_y = landmark.shift_y != nullptr ? landmark.shift_y : no_shift.data();
  for (std::size_t i = 0; i < poses.n; ++i) {
    const double c = poses.cos_heading[i], s = poses.sin_heading[i];
    const double wx = landmark.x + shift_x[i] - poses.x[i], wy = landmark.y + shift_y[i] - poses.y[i];
    const double u = c * wx + s * wy - sector.x_m, v = c * wy - s * wx - sector.y_m;
    const double range2 = u * u + v * v;
    const double along = u * sector.cos_middle + v * sector.sin_middle;
    const double in_range = range2 >= sector.min_range2_m2 ? (range2 <= sector.max_range2_m2 ? 1.0 : 0.0) : 0.0;
    count[i] += along >= sector.cos_half * std::sqrt(range2) ? in_range : 0.0;
  }
}

ViewSector view_sector(const core::FieldOfView& view, const core::Pose2& T_robot_sensor) {
  const double middle = T_robot_sensor.heading_rad + 0.5 * (view.min_bearing_rad + view.max_bearing_rad);
  const double half = 0.5 * (view.max_bearing_rad - view.min_bearing_rad);
  return {T_robot_sensor.x_m,
          T_robot_sensor.y_m,
          std::cos(middle),
          std::sin(middle),
          half >= core::pi - 1e-9 ? -2.0 : std::cos(half),
          view.min_range_m * view.min_range_m,
          view.max_range_m * view.max_range_m};
}

}  // namespace helixnav::pf_relocalize
