// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/packed_product.hpp"

#include <algorithm>
#include <numeric>

#include "helixnav/core/add_outer.hpp"

namespace helixnav::core {

using Index = Eigen::Index;

namespace {

std::vector<int> all_columns(Index count) {
  std::vector<int> columns(static_cast<std::size_t>(count));
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

}  // namespace

Panels::Panels(const Source& from, Index width) : Panels(from, all_columns(from.cols()), width) {}

Panels::Panels(Index rows, Index depth, Index width) : rows_(rows), depth_(depth), width_(width) {
  data_.resize(static_cast<std::size_t>(count() * width_ * depth_));
}

Panels::Panels(const Source& from, const std::vector<int>& columns, Index width)
    : Panels(from.rows(), static_cast<Index>(columns.size()), width) {
  for (Index p = 0; p < count(); ++p) {
    const Index first = p * width_;
    const Index filled = std::min(width_, rows_ - first);
    double* to = data_.data() + first * depth_;
    for (const int column : columns) {
      const double* source = from.data() + first + column * from.outerStride();
      std::copy(source, source + filled, to);
      to += width_;
    }
  }
}

Panels Panels::of_transposed(const Source& from, Index width, double factor) {
  Panels panels(from.cols(), from.rows(), width);
  for (Index row = 0; row < panels.rows_; ++row) {
    const double* source = from.data() + row * from.outerStride();
    const Index panel = row / width;
    double* to = panels.data_.data() + panel * width * panels.depth_ + row % width;
    for (Index k = 0; k < panels.depth_; ++k) to[k * width] = factor * source[k];
  }
  return panels;
}

namespace {

/// Tiles of C in the first columns, from the row that `first_row` gives for a column.
template <class FirstRow>
void add_tiles(double* C, Index stride_C, const Panels& left, const Panels& right, Index columns,
               const FirstRow& first_row) {
  const Index padded_rows = (left.rows() + 7) / 8 * 8;
  for (Index l = 0; l < left.count(); ++l) {
    const Index row = l * left.width();
    for (Index r = 0; r * right.width() < columns; ++r) {
      const Index column = r * right.width();
      if (row + left.width() <= first_row(column)) break;
      add_outer(C + row + column * stride_C, stride_C, std::min(left.width(), padded_rows - row),
                std::min(right.width(), columns - column), left.panel(l), left.width(), right.panel(r), right.width(),
                left.depth());
    }
  }
}

}  // namespace

void add_product(double* C, Index stride_C, const Panels& left, const Panels& right) {
  add_product(C, stride_C, left, right, right.rows());
}

void add_product(double* C, Index stride_C, const Panels& left, const Panels& right, Index columns) {
  add_tiles(C, stride_C, left, right, columns, [](Index) { return Index{0}; });
}

void add_product_lower(double* C, Index stride_C, const Panels& left, const Panels& right) {
  add_tiles(C, stride_C, left, right, right.rows(), [](Index column) { return column; });
}

}  // namespace helixnav::core
