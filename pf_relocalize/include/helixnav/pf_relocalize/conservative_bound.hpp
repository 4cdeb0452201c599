// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace helixnav::pf_relocalize {

/// The 2×2 diagonal blocks D_i [m²] of a bound blkdiag(D_1 … D_n) on a 2n×2n covariance P of n points.
using Blocks = std::vector<Eigen::Matrix2d>;

/// All rules below rest on one lemma: for every M ≻ 0, [[C M Cᵀ, −C], [−Cᵀ, M⁻¹]] ⪰ 0. Adding the two diagonal parts to
/// D_i and D_j for every pair therefore gives blkdiag(D) − P ⪰ 0. The rules differ in M. P must be symmetric positive
/// semidefinite with an even number of rows, else PreconditionError; blocks may be singular (the bases of a relative
/// map). Cost O(n²) pair additions, each about a microsecond.
/// Test: pf_relocalize/conservative_bound_test.cpp (smallest eigenvalue of bound − P over 10 000 random P; the
/// elementwise rules that look right and are wrong).

/// Eq (11) of hybrid_masson2003 with k_ij = 1, the choice of least trace: every scalar state of another landmark adds
/// |C| to the diagonal; the 2×2 block of the landmark itself is kept.
Blocks scalar_bound(const Eigen::Ref<const Eigen::MatrixXd>& P);

/// Least trace among the block additions: D_i += (C Cᵀ)^½, D_j += (Cᵀ C)^½.
Blocks trace_bound(const Eigen::Ref<const Eigen::MatrixXd>& P);

/// Additions chosen in whitened coordinates, then `sweeps` rounds over all pairs that take a pair's new addition only
/// when Σ log det D falls, from the scalar and from the whitened start, the better kept; last, everything is scaled by
/// λ_max(D^-½ P D^-½) ≤ 1, which is free. Never looser in Σ log det than scalar_bound. Source: THEORY §2.
Blocks whitened_bound(const Eigen::Ref<const Eigen::MatrixXd>& P, int sweeps = 5);

/// P ⪯ V Vᵀ + blkdiag(D): the `modes` strongest common errors kept exactly as columns of V (2n×modes), the rest bounded
/// by whitened_bound. A realisation of the map is mean + V ξ + independent block errors, ξ ~ N(0, I).
struct LatentBound {
  Eigen::MatrixXd V;
  Eigen::MatrixXd
      regression;  ///< 2n×modes, P⁻¹V: Cov(u, ξ) = Cov(u, map)·regression for any u jointly Gaussian with the map
  Blocks residual;
};
LatentBound latent_bound(const Eigen::Ref<const Eigen::MatrixXd>& P, int modes, int sweeps = 5);

/// The diagonal blocks of P, cross terms dropped: not a bound.
Blocks diagonal_blocks(const Eigen::Ref<const Eigen::MatrixXd>& P);

/// blkdiag(D) as a dense 2n×2n matrix.
Eigen::MatrixXd block_diagonal(const Blocks& blocks);

/// Groups of at most `size` neighbouring points: the set is halved across its longer side until the parts are small
/// enough. Returns indices. Cost O(n log² n).
std::vector<std::vector<int>> constellations(const std::vector<Eigen::Vector2d>& points_m, int size);

/// whitened_bound inside each group, cross terms between groups dropped: a bound on every group's marginal, not on P.
Blocks constellation_bound(const Eigen::Ref<const Eigen::MatrixXd>& P, const std::vector<std::vector<int>>& groups,
                           int sweeps = 5);

}  // namespace helixnav::pf_relocalize
