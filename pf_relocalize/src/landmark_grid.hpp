// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace helixnav::pf_relocalize {

/// Points in square cells of about one point each. Cells of a row are neighbours in memory, so that looking up a
/// rectangle is one run per row.
class LandmarkGrid {
 public:
  explicit LandmarkGrid(const std::vector<Eigen::Vector2d>& points_m);

  /// Calls f(landmark) for every landmark whose cell meets the rectangle.
  template <typename Function>
  void visit(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, Function&& f) const {
    const int first_column = cell(low_m.x() - origin_x_m_, columns_);
    const int last_column = cell(high_m.x() - origin_x_m_, columns_);
    const int first_row = cell(low_m.y() - origin_y_m_, rows_), last_row = cell(high_m.y() - origin_y_m_, rows_);
    for (int row = first_row; row <= last_row; ++row) {
      const std::uint32_t* start = starts_.data() + row * columns_;
      for (std::uint32_t k = start[first_column]; k < start[last_column + 1]; ++k) f(landmarks_[k]);
    }
  }

 private:
  /// Index of the cell at `offset_m` from the origin; beyond the rim, the cell at the rim.
  int cell(double offset_m, int count) const {
    const double scaled = offset_m * inverse_cell_;
    if (!(scaled > 0.0)) return 0;
    return scaled < count - 1 ? static_cast<int>(scaled) : count - 1;
  }

  double origin_x_m_ = 0.0, origin_y_m_ = 0.0, inverse_cell_ = 1.0;
  int columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> starts_;     // of each cell in landmarks_, and the end
  std::vector<std::uint32_t> landmarks_;  // by cell
};

}  // namespace helixnav::pf_relocalize
