// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Core>

#include "little_endian.hpp"

namespace helixnav::runs {

/// Bytes on their way to a file that is too large to be held as a whole: they are passed on in blocks.
class ByteStream {
 public:
  using Take = std::function<void(std::string_view)>;

  explicit ByteStream(Take take) : take_(std::move(take)) {}

  template <class Number>
  void number(Number value) {
    put(block_, value);
    if (block_.size() >= block_bytes) pass_on();
  }
  template <class Unsigned>
  void whole(Unsigned value) {
    put_unsigned(block_, value);
  }
  void text(std::string_view text) { block_ += text; }

  /// Lower triangle, row by row, of what is symmetric but for rounding.
  void triangle(const Eigen::Ref<const Eigen::MatrixXd>& A) {
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) number(0.5 * (A(i, j) + A(j, i)));
    }
  }

  void pass_on() {
    take_(block_);
    block_.clear();
  }

 private:
  static constexpr std::size_t block_bytes = std::size_t{1} << 20;

  Take take_;
  std::string block_;
};

}  // namespace helixnav::runs
