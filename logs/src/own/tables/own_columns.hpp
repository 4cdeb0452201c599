// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace helixnav::logs {

/// Indices into OwnTables::columns_of(Table::…).
namespace odometry_columns {
enum Column : std::size_t {
  t,
  dx,
  dy,
  dheading,
  v,
  vy,
  omega,
  steering,
  v_left,
  v_right,
  x,
  y,
  heading,  //
  sigma_x,
  sigma_y,
  sigma_heading,
  sigma_v,
  sigma_vy,
  sigma_omega,  //
  cov_xx,
  cov_xy,
  cov_xh,
  cov_yy,
  cov_yh,
  cov_hh
};
}
namespace detection_columns {
enum Column : std::size_t {
  t,
  range,
  bearing,
  x,
  y,
  sigma_range,
  sigma_bearing,
  sigma_x,
  sigma_y,
  cov_xx,
  cov_xy,
  cov_yy,  //
  sensor,
  id,
  class_name,
  size,
  sigma_size
};
}
namespace fix_columns {
enum Column : std::size_t { t, x, y, sigma };
}
namespace true_pose_columns {
enum Column : std::size_t { t, x, y, heading };
}
namespace true_landmark_columns {
enum Column : std::size_t { id, x, y };
}
namespace lost_columns {
enum Column : std::size_t { t };
}

}  // namespace helixnav::logs
