// SPDX-License-Identifier: BSD-3-Clause
// Products with the vector instructions that the processor has.
#include "helixnav/core/packed_product.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "helixnav/core/add_outer.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/wide_cholesky.hpp"

namespace helixnav::core {
namespace {

Eigen::MatrixXd normal_matrix(RandomStream& random, int rows, int cols) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

class AddOuter : public ::testing::TestWithParam<Instructions> {};

TEST_P(AddOuter, EqualsThePlainProductForAnyShape) {
  RandomStream random(7);
  for (const int rows : {8, 16, 24, 88}) {
    for (const int cols : {1, 2, 3, 7, 8, 19, 83}) {
      for (const int depth : {1, 2, 18, 131}) {
        const Eigen::MatrixXd A = normal_matrix(random, rows + 8, depth);
        const Eigen::MatrixXd B = normal_matrix(random, cols + 3, depth);
        Eigen::MatrixXd C = normal_matrix(random, rows + 16, cols);
        Eigen::MatrixXd expected = C;
        expected.topRows(rows) += A.topRows(rows) * B.topRows(cols).transpose();
        add_outer_with(GetParam(), C.data(), C.outerStride(), rows, cols, A.data(), A.outerStride(), B.data(),
                       B.outerStride(), depth);
        ASSERT_LE((C - expected).cwiseAbs().maxCoeff(), 1e-12) << rows << ' ' << cols << ' ' << depth;
      }
    }
  }
}

/// A processor is tested on the instructions it has; those it lacks cannot be run.
std::vector<Instructions> instructions_here() {
  std::vector<Instructions> all{Instructions::baseline, Instructions::avx2, Instructions::avx512};
  all.erase(std::remove_if(all.begin(), all.end(), [](Instructions i) { return !is_supported(i); }), all.end());
  return all;
}

INSTANTIATE_TEST_SUITE_P(SupportedInstructions, AddOuter, ::testing::ValuesIn(instructions_here()));

TEST(Panels, MultiplyBitForBitLikeTheMatricesTheyWereCopiedFrom) {
  RandomStream random(2);
  for (const Eigen::Index rows : {1, 8, 16, 21, 150}) {
    const Eigen::Index padded = (rows + 7) / 8 * 8;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(padded, 37);
    A.topRows(rows) = normal_matrix(random, static_cast<int>(rows), 37);
    const Eigen::MatrixXd B = normal_matrix(random, 13, 37);
    Eigen::MatrixXd direct = Eigen::MatrixXd::Zero(padded, 13);
    Eigen::MatrixXd packed = direct;
    Eigen::MatrixXd from_rows = direct;
    add_outer(direct.data(), padded, padded, 13, A.data(), padded, B.data(), B.outerStride(), 37);
    const Panels left(A.topRows(rows), left_width);
    add_product(packed.data(), padded, left, Panels(B, right_width));
    EXPECT_EQ(packed, direct) << rows << " rows";
    const Eigen::MatrixXd turned = -B.transpose();
    add_product(from_rows.data(), padded, left, Panels::of_transposed(turned, right_width, -1.0));
    EXPECT_EQ(from_rows, direct) << rows << " rows";
  }
}

/// As kept phases are packed, one after another, larger and smaller.
TEST(Panels, PackedAgainInTheSamePlaceAreAsIfNew) {
  RandomStream random(5);
  Panels again(left_width);
  again.reserve(40, 12);
  for (const int rows : {40, 7, 16, 33}) {
    const Eigen::MatrixXd from = normal_matrix(random, rows, 12);
    const std::vector<int> columns{1, 4, 5, 11};
    const Panels fresh(from, columns, left_width);
    again.pack(from, columns);
    ASSERT_EQ(again.rows(), fresh.rows());
    ASSERT_EQ(again.depth(), fresh.depth());
    for (Eigen::Index p = 0; p < fresh.count(); ++p) {
      const auto size = static_cast<std::size_t>(left_width * fresh.depth());
      EXPECT_TRUE(std::equal(fresh.panel(p), fresh.panel(p) + size, again.panel(p))) << rows << ' ' << p;
    }
  }
}

TEST(Panels, MultiplyTheLowerTriangleOnly) {
  RandomStream random(3);
  for (const Eigen::Index rows : {1, 8, 23, 100}) {
    const Eigen::Index padded = (rows + 7) / 8 * 8;
    const Eigen::MatrixXd Y = normal_matrix(random, 29, static_cast<int>(rows));
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(padded, rows);
    Eigen::MatrixXd lower = whole;
    const Panels left = Panels::of_transposed(Y, left_width);
    const Panels right = Panels::of_transposed(Y, right_width);
    add_product(whole.data(), padded, left, right);
    add_product_lower(lower.data(), padded, left, right);
    const Eigen::MatrixXd expected = whole.triangularView<Eigen::Lower>();
    const Eigen::MatrixXd got = lower.triangularView<Eigen::Lower>();
    EXPECT_EQ(got, expected) << rows << " rows";
    EXPECT_LT((whole.topRows(rows) - Y.transpose() * Y).cwiseAbs().maxCoeff(), 1e-12) << rows << " rows";
  }
}

TEST(EliminateFirst, LeavesTheFactorAndTheSchurComplement) {
  RandomStream random(4);
  for (const int n : {1, 5, 64, 71, 200}) {
    for (const int count : {1, n / 2, n}) {
      const Eigen::MatrixXd half = normal_matrix(random, n, n + 3);
      const Eigen::MatrixXd F = half * half.transpose();
      Eigen::MatrixXd larger = Eigen::MatrixXd::Constant(n + 2, n + 2, 7.0);
      larger.topLeftCorner(n, n) = F;
      ASSERT_TRUE(eliminate_first(larger.topLeftCorner(n, n), count));
      EXPECT_TRUE((larger.rightCols(2).array() == 7.0).all() && (larger.bottomRows(2).array() == 7.0).all());
      Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n, n);
      L.leftCols(count) = larger.topLeftCorner(n, count).triangularView<Eigen::Lower>();
      Eigen::MatrixXd back = L * L.transpose();
      const int rest = n - count;
      const Eigen::MatrixXd schur = larger.block(count, count, rest, rest).selfadjointView<Eigen::Lower>();
      back.bottomRightCorner(rest, rest) += schur;
      EXPECT_LT((back - F).cwiseAbs().maxCoeff(), 1e-12 * F.cwiseAbs().maxCoeff()) << n << ' ' << count;
      if (count < n) continue;
      const Eigen::MatrixXd twin = F.llt().matrixL();
      EXPECT_LT((L - twin).cwiseAbs().maxCoeff(), 1e-9 * twin.cwiseAbs().maxCoeff()) << n;
    }
  }
}

TEST(EliminateFirst, RefusesWhatIsNotPositiveDefinite) {
  for (const int bad : {0, 63, 64, 90}) {
    Eigen::MatrixXd F = Eigen::MatrixXd::Identity(100, 100);
    F(bad, bad) = -1.0;
    EXPECT_FALSE(eliminate_first(F, 100)) << bad;
    Eigen::MatrixXd same = Eigen::MatrixXd::Identity(100, 100);
    same(bad, bad) = -1.0;
    EXPECT_EQ(eliminate_first(same, bad), true) << bad;
  }
}

}  // namespace
}  // namespace helixnav::core
