// SPDX-License-Identifier: BSD-3-Clause
// The only place where a correction is applied: means by the retraction, covariances of the active part and weights by
// one low-rank product left·rightᵀ.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/add_outer.hpp"
#include "helixnav/core/errors.hpp"
#include "update/innovation.hpp"
#include "update/retraction.hpp"

namespace helixnav::cekf {
namespace {

using Index = Eigen::Index;

void pick_columns(const ReservedMatrix& from, const std::vector<int>& columns, ReservedMatrix& to) {
  to.resize(from.rows(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    to.view().col(static_cast<Index>(k)) = from.view().col(columns[k]);
  }
}

/// left = picked·Gᵀ with `extra` zero columns appended.
void whiten(const ReservedMatrix& picked, const ReservedMatrix& G, Index extra, ReservedMatrix& left) {
  left.resize(picked.rows(), G.rows() + extra);
  left.set_zero();
  if (picked.rows() == 0) return;
  core::add_outer(left.col(0), left.stride(), left.padded_rows(), G.rows(), picked.col(0), picked.stride(), G.col(0),
                  G.stride(), G.cols());
}

/// The same without G: left = picked·Hᵀ·L⁻ᵀ.
void whiten_wide(const ReservedMatrix& picked, const UpdateWorkspace& w, Index extra, ReservedMatrix& left) {
  const Index m = w.H.rows();
  left.resize(picked.rows(), m + extra);
  left.set_zero();
  if (picked.rows() == 0) return;
  auto W = left.view();
  for (const Nonzero& h : nonzeros_of(w.H)) W.col(h.row) += h.value * picked.view().col(h.column);
  const auto L = w.L.view();
  for (Index j = 0; j < m; ++j) {
    W.col(j) /= L(j, j);
    for (Index k = j + 1; k < m; ++k) {
      if (L(k, j) != 0.0) W.col(k) -= L(k, j) * W.col(j);
    }
  }
}

/// product = picked·gain.
void multiply(const ReservedMatrix& picked, const ReservedMatrix& gain, ReservedMatrix& product) {
  product.resize(picked.rows(), 1);
  product.set_zero();
  if (picked.rows() == 0) return;
  constexpr Index next = 1;  // from one element of the column `gain` to the next
  core::add_outer(product.col(0), product.stride(), product.padded_rows(), 1, picked.col(0), picked.stride(),
                  gain.col(0), next, picked.cols());
}

/// Column m + 1 of left += W·wᵀ, W the first m columns of left, w a row with its elements `stride` apart.
void add_product_to_column(ReservedMatrix& left, Index m, const double* w, Index stride) {
  if (left.rows() == 0) return;
  core::add_outer(left.col(m + 1), left.stride(), left.padded_rows(), 1, left.col(0), left.stride(), w, stride, m);
}

/// right = [−W g n] from left = [W n g].
void mirror_columns(const ReservedMatrix& left, bool transported, ReservedMatrix& right) {
  right.resize(left.rows(), left.cols());
  const Index m = left.cols() - (transported ? 2 : 0);
  right.view().leftCols(m) = -left.view().leftCols(m);
  if (!transported) return;
  right.view().col(m) = left.view().col(m + 1);
  right.view().col(m + 1) = left.view().col(m);
}

void add_to_lower(ReservedMatrix& target, const ReservedMatrix& left, const ReservedMatrix& right) {
  if (target.rows() == 0) return;
  core::add_outer_lower(target.col(0), target.stride(), target.padded_rows(), target.cols(), left.col(0), left.stride(),
                        right.col(0), right.stride(), left.cols());
}

/// Whole tiles of 4 × 4, the diagonal's among them, so that a tile is transposed in registers; then the rows left over.
void copy_lower_to_upper(ReservedMatrix& target) {
  auto T = target.view();
  const Index n = T.cols();
  constexpr Index tile = 4;
  const Index whole = n / tile * tile;
  for (Index j = 0; j < whole; j += tile) {
    for (Index k = j; k < j + tile; ++k) {
      for (Index i = k + 1; i < j + tile; ++i) T(k, i) = T(i, k);
    }
    for (Index i = j + tile; i < whole; i += tile) {
      const Eigen::Matrix4d below = T.block<tile, tile>(i, j);
      T.block<tile, tile>(j, i) = below.transpose();
    }
  }
  for (Index i = whole; i < n; ++i) {
    for (Index j = 0; j < i; ++j) T(j, i) = T(i, j);
  }
}

/// Points of the part become V·δ, in place: pairs of rows from `first` on.
void turn_pairs(const Eigen::Matrix2d& V, Index first, ReservedMatrix& delta) {
  auto d = delta.view();
  for (Index i = first; i + 1 < d.rows(); i += 2) {
    const Eigen::Vector2d turned = V * d.block<2, 1>(i, 0);
    d.block<2, 1>(i, 0) = turned;
  }
}

/// Column of n: J·Δ for pairs of rows from `first` on.
template <class Column>
void quarter_turns(const ReservedMatrix& delta, Index first, Column&& n) {
  const auto d = delta.view();
  for (Index i = first; i + 1 < d.rows(); i += 2) n.template segment<2>(i) = quarter_turn(d.block<2, 1>(i, 0));
}

/// What the update would leave on the diagonal of P.
void find_variances(const ReservedMatrix& P, const ReservedMatrix& left, const ReservedMatrix& right,
                    ReservedMatrix& variances) {
  variances.resize(P.rows(), 1);
  auto d = variances.view();
  d = P.view().diagonal();
  for (Index k = 0; k < left.cols(); ++k) d += left.view().col(k).cwiseProduct(right.view().col(k));
}

}  // namespace

void CompressedEkf::check_variances(const UpdateWorkspace& w, const char* verb) const {
  constexpr double rounding = 1e-18;  // (1 nm)², (1 nrad)²: exactly known values come out this small, with either sign
  const auto variances = w.variances.view();
  if (variances.minCoeff() >= -rounding && variances.allFinite()) return;
  for (Index i = 0; i < variances.rows(); ++i) {
    if (variances(i, 0) >= -rounding && std::isfinite(variances(i, 0))) continue;
    const bool is_pose = i < 3;
    std::ostringstream problem;
    problem << "the variance of ";
    if (is_pose) {
      problem << (i == 0 ? "x" : i == 1 ? "y" : "the heading") << " of the pose";
    } else {
      problem << "landmark " << active_.ids[static_cast<std::size_t>((i - 3) / 2)];
    }
    problem << " would go from " << active_.P.view()(i, i) << " to " << variances(i, 0);
    throw core::NumericalError(problem_with(w, verb, problem.str().c_str()));
  }
}

void CompressedEkf::apply_correction(UpdateWorkspace& w, const char* verb) {
  const bool transported = options_.retraction == Retraction::right_invariant;
  pick_columns(active_.P, w.involved, w.picked_active);
  pick_columns(active_.A, w.involved, w.picked_weights);
  multiply(w.picked_active, w.gain, w.delta_active);
  multiply(w.picked_weights, w.gain, w.delta_weights);
  if (!w.delta_active.view().allFinite() || !w.delta_weights.view().allFinite()) {
    throw core::NumericalError(problem_with(w, verb, "the correction is not finite"));
  }
  const Index extra = transported ? 2 : 0;
  if (is_wide(w)) {
    whiten_wide(w.picked_active, w, extra, w.left_active);
    whiten_wide(w.picked_weights, w, extra, w.left_weights);
  } else {
    whiten(w.picked_active, w.G, extra, w.left_active);
    whiten(w.picked_weights, w.G, extra, w.left_weights);
  }
  if (transported) add_transport(w);
  mirror_columns(w.left_active, transported, w.right_active);
  mirror_columns(w.left_weights, transported, w.right_weights);
  find_variances(active_.P, w.left_active, w.right_active, w.variances);
  check_variances(w, verb);

  // Nothing below allocates or throws.
  add_to_lower(active_.P, w.left_active, w.right_active);
  copy_lower_to_upper(active_.P);
  add_to_lower(active_.M, w.left_weights, w.right_weights);
  if (active_.A.rows() > 0) {
    core::add_outer(active_.A.col(0), active_.A.stride(), active_.A.padded_rows(), active_.A.cols(),
                    w.left_weights.col(0), w.left_weights.stride(), w.right_active.col(0), w.right_active.stride(),
                    w.left_weights.cols());
  }
  move_means(w);
  active_.rows += static_cast<double>(w.nu.rows());
}

/// N = I + n·e_θᵀ with n = J·Δ carries the covariance to the corrected point (THEORY §1b): P' = N·P·Nᵀ = P + n·gᵀ +
/// g·nᵀ, g = P(:, θ) + ½·P(θ, θ)·n, P after the update. Turns the corrections δ into displacements Δ.
void CompressedEkf::add_transport(UpdateWorkspace& w) const {
  const Eigen::Matrix2d V = turning_average(w.delta_active.view()(2, 0));
  turn_pairs(V, 3, w.delta_active);
  const Eigen::Vector2d vehicle = V * w.delta_active.view().topRows<2>();
  w.delta_active.view().topRows<2>() = vehicle;
  turn_pairs(V, 0, w.delta_weights);

  const Index m = w.left_active.cols() - 2;
  auto active = w.left_active.view();
  auto weights = w.left_weights.view();
  active.col(m).head<2>() = quarter_turn(vehicle);
  quarter_turns(w.delta_active, 3, active.col(m));
  quarter_turns(w.delta_weights, 0, weights.col(m));

  active.col(m + 1) = -active_.P.view().col(2);
  weights.col(m + 1) = -active_.A.view().col(2);
  const double* w_theta = w.left_active.col(0) + 2;
  add_product_to_column(w.left_active, m, w_theta, w.left_active.stride());
  add_product_to_column(w.left_weights, m, w_theta, w.left_active.stride());
  const double half_variance = -0.5 * active(2, m + 1);
  active.col(m + 1) = half_variance * active.col(m) - active.col(m + 1);
  weights.col(m + 1) = half_variance * weights.col(m) - weights.col(m + 1);
}

void CompressedEkf::move_means(const UpdateWorkspace& w) {
  const auto delta = w.delta_active.view();
  active_.pose = core::Pose2(active_.pose.vector() + delta.block<3, 1>(0, 0));
  for (std::size_t i = 0; i < active_.points_m.size(); ++i) {
    active_.points_m[i] += delta.block<2, 1>(ActivePart::column(static_cast<int>(i)), 0);
  }
  active_.theta += w.delta_weights.view().col(0);
}

}  // namespace helixnav::cekf
