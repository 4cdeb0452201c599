// SPDX-License-Identifier: BSD-3-Clause
#include "matrices/packed_product.hpp"

#include <algorithm>
#include <numeric>

#include "matrices/add_outer.hpp"

namespace helixnav::cekf {

using Index = Eigen::Index;

namespace {

std::vector<int> all_columns(Index count) {
  std::vector<int> columns(static_cast<std::size_t>(count));
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

}  // namespace

Panels::Panels(const Source& from, Index width) : Panels(from, all_columns(from.cols()), width) {}

Panels::Panels(const Source& from, const std::vector<int>& columns, Index width)
    : rows_(from.rows()), depth_(static_cast<Index>(columns.size())), width_(width) {
  data_.resize(static_cast<std::size_t>(count() * width_ * depth_));
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

void add_product(double* C, Index stride_C, const Panels& left, const Panels& right) {
  const Index padded_rows = (left.rows() + 7) / 8 * 8;
  for (Index l = 0; l < left.count(); ++l) {
    const Index row = l * left.width();
    for (Index r = 0; r < right.count(); ++r) {
      const Index column = r * right.width();
      add_outer(C + row + column * stride_C, stride_C, std::min(left.width(), padded_rows - row),
                std::min(right.width(), right.rows() - column), left.panel(l), left.width(), right.panel(r),
                right.width(), left.depth());
    }
  }
}

}  // namespace helixnav::cekf
