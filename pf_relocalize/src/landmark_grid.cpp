// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_grid.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::pf_relocalize {

LandmarkGrid::LandmarkGrid(const std::vector<Eigen::Vector2d>& points_m) {
  if (points_m.empty()) {
    starts_.assign(2, 0);
    return;
  }
  Eigen::Vector2d low = points_m.front(), high = low;
  for (const Eigen::Vector2d& p : points_m) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d size = high - low;
  const double count = static_cast<double>(points_m.size());
  const double spread_m = std::max(std::sqrt(size.x() * size.y() / count), size.maxCoeff() / (4.0 * count));
  const double cell_m = spread_m > 0.0 ? spread_m : 1.0;  // all in one place: any cell will do
  origin_x_m_ = low.x();
  origin_y_m_ = low.y();
  inverse_cell_ = 1.0 / cell_m;
  columns_ = static_cast<int>(size.x() * inverse_cell_) + 1;
  rows_ = static_cast<int>(size.y() * inverse_cell_) + 1;
  const auto cell_of = [&](const Eigen::Vector2d& p) {
    return static_cast<std::size_t>(cell(p.y() - low.y(), rows_) * columns_ + cell(p.x() - low.x(), columns_));
  };
  starts_.assign(static_cast<std::size_t>(rows_ * columns_) + 1, 0);
  for (const Eigen::Vector2d& p : points_m) ++starts_[cell_of(p) + 1];
  for (std::size_t k = 1; k < starts_.size(); ++k) starts_[k] += starts_[k - 1];
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  landmarks_.resize(points_m.size());
  for (std::size_t i = 0; i < points_m.size(); ++i)
    landmarks_[next[cell_of(points_m[i])]++] = static_cast<std::uint32_t>(i);
}

}  // namespace helixnav::pf_relocalize
