// SPDX-License-Identifier: BSD-3-Clause
// The components of the filter.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/cekf/packed_triangle.hpp"
#include "helixnav/cekf/passive_covariance.hpp"
#include "helixnav/cekf/reserved_matrix.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::cekf {
namespace {

Eigen::MatrixXd random_matrix(core::RandomStream& random, int rows, int cols) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

TEST(PackedTriangle, ComesBackWithBothTriangles) {
  for (const Eigen::Index n : {0, 1, 7, 20}) {
    ReservedMatrix symmetric(n, n);
    const Eigen::MatrixXd some = Eigen::MatrixXd::NullaryExpr(n, n, [](Eigen::Index i, Eigen::Index j) {
      return static_cast<double>(100 * std::max(i, j) + std::min(i, j));
    });
    symmetric.view() = some;
    const PackedTriangle packed(symmetric);
    EXPECT_EQ(packed.unpacked().view(), some) << n;
    EXPECT_EQ(packed.bytes(), static_cast<std::size_t>(4 * n * (n + 1)));
    symmetric.view().triangularView<Eigen::StrictlyUpper>().setZero();
    EXPECT_TRUE(packed == PackedTriangle(symmetric)) << "the lower triangle is read";
  }
}

TEST(ReservedMatrix, KeepsWhatIsCommonAndZeroesTheRest) {
  ReservedMatrix matrix(5, 4);
  matrix.view().setConstant(2.0);
  const double* const storage = matrix.col(0);
  matrix.resize(3, 2);
  matrix.resize(5, 4);
  EXPECT_EQ(matrix.col(0), storage);
  EXPECT_EQ(matrix.view().sum(), 2.0 * 6);
  matrix.resize(40, 30);
  EXPECT_EQ(matrix.view().sum(), 2.0 * 6);
  EXPECT_EQ(matrix.stride() % 8, 0);
  const ReservedMatrix copy = matrix;
  matrix.resize(2, 1);
  EXPECT_EQ(copy.view().sum(), 2.0 * 6);
  matrix = copy;
  EXPECT_EQ(matrix.view(), copy.view());
}

TEST(PassiveCovariance, AddsAProductAndReadsItBack) {
  core::RandomStream random(1);
  PassiveCovariance store;
  store.grow(300);
  const Eigen::MatrixXd E = random_matrix(random, 300, 21);
  Eigen::MatrixXd half = random_matrix(random, 21, 21);
  std::vector<int> columns_used;
  for (int k = 0; k < 21; ++k) {
    if (k == 4 || k == 17) {
      half.row(k).setZero();
      half.col(k).setZero();
    } else {
      columns_used.push_back(k);
    }
  }
  const Eigen::MatrixXd response = E * (half + half.transpose());
  store.add_symmetric_product(response, E, columns_used);
  Eigen::MatrixXd dense = response * E.transpose();
  const std::vector<int> slots = {3, 140, 64};
  Eigen::MatrixXd columns = random_matrix(random, 300, 6);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {  // what is written must itself be symmetric
      const Eigen::Index ci = 2 * static_cast<Eigen::Index>(i);
      const Eigen::Index cj = 2 * static_cast<Eigen::Index>(j);
      columns.block<2, 2>(2 * slots[i], cj).setConstant(static_cast<double>(1 + i + j));
      columns.block<2, 2>(2 * slots[j], ci).setConstant(static_cast<double>(1 + i + j));
    }
  }
  store.overwrite(slots, columns);
  for (std::size_t k = 0; k < 3; ++k) {
    dense.middleCols<2>(2 * slots[k]) = columns.middleCols<2>(2 * static_cast<Eigen::Index>(k));
    dense.middleRows<2>(2 * slots[k]) = columns.middleCols<2>(2 * static_cast<Eigen::Index>(k)).transpose();
  }
  Eigen::MatrixXd read(300, 2);
  for (const int slot : {0, 3, 63, 64, 149}) {
    store.copy_columns(slot, read);
    EXPECT_LE((read - dense.middleCols<2>(2 * slot)).cwiseAbs().maxCoeff(), 1e-11) << slot;
    EXPECT_LE((store.block(slot, 70) - dense.block<2, 2>(2 * slot, 140)).cwiseAbs().maxCoeff(), 1e-11) << slot;
  }
}

}  // namespace
}  // namespace helixnav::cekf
