// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/packed_product.hpp"

#include <algorithm>

#include "helixnav/core/add_outer.hpp"

namespace helixnav::core {

using Index = Eigen::Index;

Panels::Panels(const Source& from, Index width) : Panels(width) { pack(from); }

Panels::Panels(const Source& from, const std::vector<int>& columns, Index width) : Panels(width) {
  pack(from, columns);
}

Panels::Panels(Index rows, Index depth, Index width) : Panels(width) { set_zero(rows, depth); }

void Panels::set_zero(Index rows, Index depth) {
  rows_ = rows;
  depth_ = depth;
  data_.assign(static_cast<std::size_t>(count() * width_ * depth_), 0.0);
}

void Panels::reserve(Index rows, Index depth) {
  data_.reserve(static_cast<std::size_t>((rows + width_ - 1) / width_ * width_ * depth));
}

void Panels::copy_column(const double* source, Index k) {
  for (Index first = 0; first < rows_; first += width_) {
    const Index filled = std::min(width_, rows_ - first);
    std::copy(source + first, source + first + filled, data_.data() + first * depth_ + k * width_);
  }
}

void Panels::pack(const Source& from) {
  set_zero(from.rows(), from.cols());
  for (Index k = 0; k < depth_; ++k) copy_column(from.data() + k * from.outerStride(), k);
}

void Panels::pack(const Source& from, const std::vector<int>& columns) {
  set_zero(from.rows(), static_cast<Index>(columns.size()));
  for (Index k = 0; k < depth_; ++k) {
    copy_column(from.data() + columns[static_cast<std::size_t>(k)] * from.outerStride(), k);
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
