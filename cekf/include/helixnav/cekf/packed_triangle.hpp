// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "helixnav/cekf/reserved_matrix.hpp"

namespace helixnav::cekf {

/// Copy of a symmetric matrix in half its memory: the lower triangle, column by column.
/// Test: cekf/pieces_test.cpp.
class PackedTriangle {
 public:
  PackedTriangle() = default;
  /// Only the lower triangle is read.
  explicit PackedTriangle(const ReservedMatrix& symmetric);

  /// Both triangles.
  ReservedMatrix unpacked() const;
  std::size_t bytes() const { return static_cast<std::size_t>(lower_.size()) * sizeof(double); }
  bool operator==(const PackedTriangle& other) const { return rows_ == other.rows_ && lower_ == other.lower_; }

 private:
  Eigen::Index rows_ = 0;
  Eigen::VectorXd lower_;
};

}  // namespace helixnav::cekf
