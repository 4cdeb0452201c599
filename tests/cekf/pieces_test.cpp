// SPDX-License-Identifier: BSD-3-Clause
// The pieces the filter is made of.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/cekf/passive_covariance.hpp"
#include "helixnav/cekf/reserved_matrix.hpp"
#include "helixnav/core/random.hpp"
#include "matrices/add_outer.hpp"
#include "matrices/packed_product.hpp"

namespace helixnav::cekf {
namespace {

Eigen::MatrixXd random_matrix(core::RandomStream& random, int rows, int cols) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

class AddOuter : public testing::TestWithParam<Instructions> {};

TEST_P(AddOuter, EqualsThePlainProductForAnyShape) {
  core::RandomStream random(7);
  for (const int rows : {8, 16, 24, 88}) {
    for (const int cols : {1, 2, 3, 7, 8, 19, 83}) {
      for (const int depth : {1, 2, 18, 131}) {
        const Eigen::MatrixXd A = random_matrix(random, rows + 8, depth);
        const Eigen::MatrixXd B = random_matrix(random, cols + 3, depth);
        Eigen::MatrixXd C = random_matrix(random, rows + 16, cols);
        Eigen::MatrixXd expected = C;
        expected.topRows(rows) += A.topRows(rows) * B.topRows(cols).transpose();
        add_outer_with(GetParam(), C.data(), C.outerStride(), rows, cols, A.data(), A.outerStride(), B.data(),
                       B.outerStride(), depth);
        ASSERT_LE((C - expected).cwiseAbs().maxCoeff(), 1e-12) << rows << ' ' << cols << ' ' << depth;
      }
    }
  }
}

/// A processor is tested on what it has; on what it lacks there is nothing to run.
std::vector<Instructions> supported() {
  std::vector<Instructions> all{Instructions::baseline, Instructions::avx2, Instructions::avx512};
  all.erase(std::remove_if(all.begin(), all.end(), [](Instructions i) { return !is_supported(i); }), all.end());
  return all;
}

INSTANTIATE_TEST_SUITE_P(SupportedInstructions, AddOuter, testing::ValuesIn(supported()));

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

TEST(Panels, MultiplyBitForBitLikeTheMatricesTheyWereCopiedFrom) {
  core::RandomStream random(2);
  for (const Eigen::Index rows : {1, 8, 16, 21, 150}) {
    const ReservedMatrix zero(rows, 13);
    ReservedMatrix A(rows, 37);
    A.view() = random_matrix(random, rows, 37);
    const Eigen::MatrixXd B = random_matrix(random, 13, 37);
    ReservedMatrix direct = zero;
    ReservedMatrix packed = zero;
    add_outer(direct.col(0), direct.stride(), direct.padded_rows(), 13, A.col(0), A.stride(), B.data(), B.outerStride(),
              37);
    add_product(packed.col(0), packed.stride(), Panels(A.view(), left_width), Panels(B, right_width));
    EXPECT_EQ(packed.view(), direct.view()) << rows << " rows";
  }
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
