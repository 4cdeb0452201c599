// SPDX-License-Identifier: BSD-3-Clause
#include "solve/partial_cholesky.hpp"

#include <Eigen/Cholesky>

namespace helixnav::atlas {

bool partial_cholesky(Square F, Eigen::Index ne) {
  if (ne == 0) return true;
  Square D = F.topLeftCorner(ne, ne);
  const Eigen::LLT<Square> llt(D);
  if (llt.info() != Eigen::Success) return false;
  const Eigen::Index rest = F.rows() - ne;
  auto below = F.bottomLeftCorner(rest, ne);
  D.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
  F.bottomRightCorner(rest, rest).selfadjointView<Eigen::Lower>().rankUpdate(below, -1.0);
  return true;
}

void solve_lower(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& L,
                 Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> B) {
  L.triangularView<Eigen::Lower>().solveInPlace(B);
}

void add_gram(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& Y, Square P) {
  if (Y.rows() == 0) return;  // a product of no depth divides by zero in Eigen
  P.selfadjointView<Eigen::Lower>().rankUpdate(Y.transpose());
}

void subtract_product(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& A,
                      const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& B,
                      Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> C) {
  C.noalias() -= A * B;
}

}  // namespace helixnav::atlas
