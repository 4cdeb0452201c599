// SPDX-License-Identifier: BSD-3-Clause
#include "packed_product.hpp"

#include <algorithm>

#include "add_outer.hpp"

namespace helixnav::cekf {

using Index = Eigen::Index;

Panels::Panels(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& from, Index width)
    : rows_(from.rows()), depth_(from.cols()), width_(width) {
  data_.resize(static_cast<std::size_t>(count() * width_ * depth_));
  for (Index p = 0; p < count(); ++p) {
    const Index first = p * width_;
    const Index filled = std::min(width_, rows_ - first);
    double* to = data_.data() + first * depth_;
    for (Index k = 0; k < depth_; ++k, to += width_) {
      const double* source = from.data() + first + k * from.outerStride();
      std::copy(source, source + filled, to);
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
