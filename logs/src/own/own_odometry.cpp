// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "own/tables/own_columns.hpp"
#include "own/tables/own_tables.hpp"
#include "plausible.hpp"

namespace helixnav::logs {
namespace {

struct KindColumns {
  OdometryKind kind;
  std::vector<std::size_t> needed;    ///< all are required for this kind, and any one is a sign of it
  std::vector<std::size_t> optional;  ///< also belong to it
};

const std::vector<KindColumns>& kinds() {
  using namespace odometry_columns;
  // never destroyed: a thread may still be here when the process ends
  static const auto& all = *new const std::vector<KindColumns>{
      {OdometryKind::increments, {dx, dheading}, {dy}}, {OdometryKind::velocities, {v, omega}, {vy}},
      {OdometryKind::steering, {v, steering}, {}},      {OdometryKind::wheels, {v_left, v_right}, {}},
      {OdometryKind::poses, {x, y, heading}, {}},
  };
  return all;
}

std::size_t present(const TableColumns& columns, const KindColumns& kind) {
  std::size_t count = 0;
  for (const std::size_t column : kind.needed) count += columns.has(column) ? 1 : 0;
  return count;
}

std::string names(const TableColumns& columns, const std::vector<std::size_t>& list) {
  std::string text;
  for (const std::size_t column : list) text += (text.empty() ? "" : ", ") + columns.name_of(column);
  return text;
}

/// The only kind of odometry that the columns allow.
const KindColumns& kind_of(const TableColumns& columns) {
  const KindColumns* found = nullptr;
  const KindColumns* nearly = nullptr;
  for (const KindColumns& kind : kinds()) {
    const std::size_t count = present(columns, kind);
    if (count == kind.needed.size() && found != nullptr) {
      columns.fail_header("the columns make two kinds of odometry, " + names(columns, found->needed) + " and " +
                          names(columns, kind.needed) + "; keep one");
    }
    if (count == kind.needed.size()) found = &kind;
    if (count > 0 && (nearly == nullptr || count > present(columns, *nearly))) nearly = &kind;
  }
  if (found != nullptr) return *found;
  if (nearly != nullptr) {
    for (const std::size_t column : nearly->needed) columns.require(column);
  }
  columns.fail_header(
      "no odometry in these columns: expected dx_m, dy_m, dheading_rad (increments), v_mps, omega_radps (velocities), "
      "v_mps, steering_rad (a car), v_left_mps, v_right_mps (two wheels) or x_m, y_m, heading_rad (dead reckoning)");
}

bool has_sigmas(const TableColumns& columns, OdometryKind kind) {
  using namespace odometry_columns;
  const bool increments = columns.has(sigma_x) && columns.has(sigma_heading);
  const bool velocities = columns.has(sigma_v) && columns.has(sigma_omega);
  return (kind == OdometryKind::increments && increments) || (kind == OdometryKind::velocities && velocities);
}

bool has_covariance(const TableColumns& columns) { return columns.has(odometry_columns::cov_xx); }

void refuse_stray_noise(const TableColumns& columns, OdometryKind kind) {
  using namespace odometry_columns;
  for (const std::size_t column : {cov_xy, cov_xh, cov_yy, cov_yh, cov_hh}) {
    if (has_covariance(columns)) columns.require(column);
  }
  if (has_covariance(columns) && kind != OdometryKind::increments) {
    columns.fail_header(
        "covariances are known of increments only (dx_m, dy_m, dheading_rad); leave out cov_xx …, and "
        "tell the noise in vehicle.toml");
  }
  for (const std::size_t column : {sigma_x, sigma_y, sigma_heading, sigma_v, sigma_vy, sigma_omega}) {
    if (!columns.has(column) || has_sigmas(columns, kind)) continue;
    columns.fail_header("column " + columns.name_of(column) +
                        " does not fit: increments take sigma_x_m, sigma_y_m, sigma_heading_rad, velocities take "
                        "sigma_v_mps, sigma_omega_radps");
  }
  if (has_covariance(columns) && has_sigmas(columns, kind)) columns.fail_header("covariances and sigmas: keep one");
}

Eigen::Matrix3d covariance_of(const Row& row) {
  using namespace odometry_columns;
  Eigen::Matrix3d Q;
  const double xy = row.number(cov_xy), xh = row.number(cov_xh), yh = row.number(cov_yh);
  Q << row.number(cov_xx), xy, xh, xy, row.number(cov_yy), yh, xh, yh, row.number(cov_hh);
  const Eigen::Vector3d eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(Q).eigenvalues();
  if (eigenvalues[0] < -1e-9 * eigenvalues[2]) row.fail(cov_xx, "this covariance is not positive semidefinite");
  return Q;
}

Eigen::Matrix3d variances_of(const Row& row, OdometryKind kind) {
  using namespace odometry_columns;
  const bool increments = kind == OdometryKind::increments;
  const auto sigma = [&](std::size_t column) {
    return row.columns().has(column) ? row.number_between(column, 0.0, 1e6) : 0.0;
  };
  const Eigen::Vector3d sigmas(sigma(increments ? sigma_x : sigma_v), sigma(increments ? sigma_y : sigma_vy),
                               sigma(increments ? sigma_heading : sigma_omega));
  return sigmas.cwiseAbs2().asDiagonal();
}

constexpr double most_m = 1e7, most_mps = 1e4, most_radps = 1e3;

Eigen::Vector3d value_of(const Row& row, OdometryKind kind) {
  using namespace odometry_columns;
  const auto if_there = [&](std::size_t column, double most) {
    return row.columns().has(column) ? row.number_between(column, -most, most) : 0.0;
  };
  switch (kind) {
    case OdometryKind::increments:
      return {row.number_between(dx, -most_motion_m, most_motion_m), if_there(dy, most_motion_m), row.angle(dheading)};
    case OdometryKind::velocities:
      return {row.number_between(v, -most_mps, most_mps), if_there(vy, most_mps),
              row.number_between(omega, -most_radps, most_radps)};
    case OdometryKind::steering:
      return {row.number_between(v, -most_mps, most_mps), row.number_between(steering, -1.5, 1.5), 0.0};
    case OdometryKind::wheels:
      return {row.number_between(v_left, -most_mps, most_mps), row.number_between(v_right, -most_mps, most_mps), 0.0};
    case OdometryKind::poses:
      return {row.number_between(x, -most_m, most_m), row.number_between(y, -most_m, most_m),
              row.number_between(heading, -1e6, 1e6)};
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace

std::string_view name_of(OdometryKind kind) {
  switch (kind) {
    case OdometryKind::increments:
      return "increments";
    case OdometryKind::velocities:
      return "speed and turn rate";
    case OdometryKind::steering:
      return "wheel speed and steering angle";
    case OdometryKind::wheels:
      return "speeds of the left and the right wheel";
    case OdometryKind::poses:
      return "poses of dead reckoning";
  }
  return "unknown";
}

void OwnTables::begin_odometry(const TableColumns& columns) {
  columns.require(odometry_columns::t);
  const KindColumns& kind = kind_of(columns);
  for (const KindColumns& other : kinds()) {
    for (const std::size_t column : other.needed) {
      const bool own = std::find(kind.needed.begin(), kind.needed.end(), column) != kind.needed.end();
      if (columns.has(column) && !own) {
        remark(columns.path() + ": column " + columns.name_of(column) + " is not used: motion is taken from " +
               names(columns, kind.needed));
      }
    }
  }
  refuse_stray_noise(columns, kind.kind);
  if (odometry_known_ && kind.kind != log_.odometry_kind) {
    columns.fail_header("odometry as " + std::string(logs::name_of(kind.kind)) + " after " +
                        std::string(logs::name_of(log_.odometry_kind)) + "; a log has one kind");
  }
  log_.odometry_kind = kind.kind;
  odometry_known_ = true;
}

void OwnTables::add_odometry(const Row& row) {
  OwnOdometry odometry;
  odometry.t_ns = times_[0].take(row, odometry_columns::t);
  odometry.value = value_of(row, log_.odometry_kind);
  const bool covariance = has_covariance(row.columns());
  if (covariance || has_sigmas(row.columns(), log_.odometry_kind)) {
    log_.odometry_covariances.resize(log_.odometry.size(), Eigen::Matrix3d::Zero());
    log_.odometry_covariances.push_back(covariance ? covariance_of(row) : variances_of(row, log_.odometry_kind));
  }
  log_.odometry.push_back(odometry);
}

}  // namespace helixnav::logs
