// SPDX-License-Identifier: BSD-3-Clause
#include "own_columns.hpp"

#include <array>

#include "own_tables.hpp"

namespace helixnav::logs {
namespace {

const ColumnKind time_column{"t", Measure::time, {"time", "timestamp", "stamp"}};
const ColumnKind heading_column{"heading", Measure::angle, {"yaw", "theta"}};

}  // namespace

std::string_view OwnTables::name_of(Table table) {
  constexpr std::string_view names[table_count] = {"odometry",    "detections",      "fixes",
                                                   "truth_poses", "truth_landmarks", "lost"};
  return names[static_cast<std::size_t>(table)];
}

const std::vector<ColumnKind>& OwnTables::columns_of(Table table) {
  using M = Measure;
  // never destroyed: a thread may still be here when the process ends
  static const auto& of = *new const std::array<std::vector<ColumnKind>, table_count>{{
      {time_column,
       {"dx", M::length},
       {"dy", M::length},
       {"dheading", M::angle, {"dyaw", "dtheta", "turn"}},
       {"v", M::speed, {"vx", "speed"}},
       {"vy", M::speed},
       {"omega", M::turn_rate, {"yaw_rate", "turn_rate", "w"}},
       {"steering", M::angle, {"steering_angle"}},
       {"v_left", M::speed, {"left"}},
       {"v_right", M::speed, {"right"}},
       {"x", M::length},
       {"y", M::length},
       heading_column,
       {"sigma_x", M::length},
       {"sigma_y", M::length},
       {"sigma_heading", M::angle},
       {"sigma_v", M::speed},
       {"sigma_vy", M::speed},
       {"sigma_omega", M::turn_rate},
       {"cov_xx"},
       {"cov_xy"},
       {"cov_xh"},
       {"cov_yy"},
       {"cov_yh"},
       {"cov_hh"}},
      {time_column,
       {"range", M::length, {"distance"}},
       {"bearing", M::angle, {"azimuth", "angle"}},
       {"x", M::length},
       {"y", M::length},
       {"sigma_range", M::length},
       {"sigma_bearing", M::angle},
       {"sigma_x", M::length},
       {"sigma_y", M::length},
       {"cov_xx"},
       {"cov_xy"},
       {"cov_yy"},
       {"sensor", M::text},
       {"id", M::text, {"label", "landmark"}},
       {"class", M::text},
       {"size", M::length, {"diameter"}},
       {"sigma_size", M::length, {"sigma_diameter"}}},
      {time_column, {"x", M::length}, {"y", M::length}, {"sigma", M::length}},
      {time_column, {"x", M::length}, {"y", M::length}, heading_column},
      {{"id", M::text, {"label", "landmark"}}, {"x", M::length}, {"y", M::length}},
      {time_column},
  }};
  return of[static_cast<std::size_t>(table)];
}

}  // namespace helixnav::logs
