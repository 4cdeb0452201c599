// SPDX-License-Identifier: BSD-3-Clause
#include "update/innovation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "helixnav/cekf/active_part.hpp"
#include "helixnav/core/add_outer.hpp"
#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {
namespace {

using Index = Eigen::Index;

void size_rows(UpdateWorkspace& w, Index rows) {
  w.H.resize(rows, static_cast<Index>(w.involved.size()));
  w.R.resize(rows, rows);
  w.nu.resize(rows, 1);
  w.H.set_zero();
  w.R.set_zero();
}

/// 1/√S_ii, which scales S to a unit diagonal.
void find_scale(const ReservedMatrix& S, ReservedMatrix& scale) {
  scale.resize(S.rows(), 1);
  for (Index i = 0; i < S.rows(); ++i) scale.view()(i, 0) = 1.0 / std::sqrt(S.view()(i, i));
}

/// Of S scaled: both triangles are computed, and differ by rounding.
double asymmetry_of(const ReservedMatrix& S, const ReservedMatrix& scale) {
  const auto s = S.view();
  const auto by = scale.view();
  double largest = 0.0;
  for (Index j = 0; j < s.cols(); ++j) {
    for (Index i = j + 1; i < s.rows(); ++i) {
      largest = std::max(largest, std::abs(s(i, j) - s(j, i)) * by(i, 0) * by(j, 0));
    }
  }
  return largest;
}

/// Lower Cholesky factor in place, column by column; the upper triangle is left as it was. False when a pivot is not
/// positive. `least`: lowered to the least pivot of S scaled.
bool factor_in_place(ReservedMatrix& S, const ReservedMatrix& scale, double& least) {
  auto L = S.view();
  for (Index j = 0; j < L.cols(); ++j) {
    const double pivot = L(j, j);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    least = std::min(least, pivot * scale.view()(j, 0) * scale.view()(j, 0));
    const Index below = L.rows() - j - 1;
    L.col(j).tail(below + 1) /= std::sqrt(pivot);
    for (Index k = j + 1; k < L.cols(); ++k) L.col(k).tail(L.rows() - k) -= L(k, j) * L.col(j).tail(L.rows() - k);
  }
  return true;
}

/// B becomes L⁻¹·B. In each column the rows before the first nonzero are skipped: in the columns of a landmark H is
/// nonzero only from its own sighting on.
void solve_in_place(const ReservedMatrix& lower, ReservedMatrix& right) {
  const auto L = lower.view();
  auto B = right.view();
  for (Index j = 0; j < B.cols(); ++j) {
    for (Index k = 0; k < B.rows(); ++k) {
      if (B(k, j) == 0.0) continue;
      B(k, j) /= L(k, k);
      const Index below = B.rows() - k - 1;
      B.col(j).tail(below) -= B(k, j) * L.col(k).tail(below);
    }
  }
}

/// G = H·P, and L becomes L + G·Hᵀ.
void multiply_by_sparse(const std::vector<Nonzero>& H, UpdateWorkspace& w) {
  auto G = w.G.view();
  const auto P = w.P.view();
  for (Index j = 0; j < G.cols(); ++j) {
    for (const Nonzero& h : H) G(h.row, j) += h.value * P(h.column, j);
  }
  for (const Nonzero& h : H) w.L.view().col(h.row) += h.value * G.col(h.column);
}

/// L of S, and y.
void factor_innovation(UpdateWorkspace& w, const char* verb) {
  const Index m = w.H.rows();
  const Index n = w.H.cols();
  w.G.resize(m, n);
  w.G.set_zero();
  w.L = w.R;
  if (is_wide(w)) {
    multiply_by_sparse(nonzeros_of(w.H), w);
  } else {
    core::add_outer(w.G.col(0), w.G.stride(), w.G.padded_rows(), n, w.H.col(0), w.H.stride(), w.P.col(0), w.P.stride(),
                    n);
    core::add_outer(w.L.col(0), w.L.stride(), w.L.padded_rows(), m, w.G.col(0), w.G.stride(), w.H.col(0), w.H.stride(),
                    n);
  }
  core::NumericalHealth health;
  find_scale(w.L, w.scale);
  health.asymmetry = asymmetry_of(w.L, w.scale);
  if (!factor_in_place(w.L, w.scale, health.least_pivot)) {
    throw core::NumericalError(problem_with(w, verb, "the innovation covariance is not positive definite"));
  }
  w.health.note(health);
  w.y = w.nu;
  solve_in_place(w.L, w.y);
}

}  // namespace

void check_observation_of(const Match& match, const char* verb) {
  try {
    core::check_observation(match.observation);
    if (!match.T_robot_sensor.vector().allFinite()) throw core::PreconditionError("T_robot_sensor is not finite");
  } catch (const core::PreconditionError& error) {
    std::ostringstream problem;
    problem << verb << ": landmark " << match.landmark << ": " << error.what();
    throw core::PreconditionError(problem.str());
  }
}

void check_fix(const core::AbsoluteFix& fix, const char* verb) {
  try {
    core::check(fix);
  } catch (const core::PreconditionError& error) {
    throw core::PreconditionError(std::string(verb) + ": " + error.what());
  }
}

std::string problem_with(const UpdateWorkspace& w, const char* verb, const char* what) {
  std::ostringstream problem;
  problem << verb << ": " << what << "; landmarks";
  for (const core::LandmarkId id : w.ids) problem << ' ' << id;
  return problem.str();
}

void name_landmarks(const std::vector<Match>& matches, UpdateWorkspace& w) {
  w.ids.clear();
  w.landmark_of_row.clear();
  for (const Match& match : matches) {
    const auto found = std::find(w.ids.begin(), w.ids.end(), match.landmark);
    w.landmark_of_row.push_back(static_cast<int>(found - w.ids.begin()));
    if (found == w.ids.end()) w.ids.push_back(match.landmark);
  }
}

void linearise_sightings(const std::vector<Match>& matches, UpdateWorkspace& w, const char* verb) {
  Index rows = 0;
  for (const Match& match : matches) rows += core::dimension(match.observation.kind);
  size_rows(w, rows);
  Index row = 0;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const core::Observation& z = matches[k].observation;
    const int landmark = w.landmark_of_row[k];
    core::PredictedObservation predicted;
    try {
      predicted = core::predict_observation(z.kind, w.pose, matches[k].T_robot_sensor,
                                            w.points_m[static_cast<std::size_t>(landmark)]);
    } catch (const core::NumericalError& error) {
      throw core::NumericalError(problem_with(w, verb, error.what()));
    }
    const int d = core::dimension(z.kind);
    w.H.view().block(row, 0, d, 3) = predicted.H_pose;
    w.H.view().block(row, ActivePart::column(landmark), d, 2) = predicted.H_landmark;
    w.R.view().block(row, row, d, d) = z.R;
    w.nu.view().block(row, 0, d, 1) = core::innovation(z.kind, z.z, predicted.z_hat);
    row += d;
  }
}

void linearise_fix(const core::AbsoluteFix& fix, UpdateWorkspace& w) {
  size_rows(w, 2);
  const Eigen::Vector2d arm_world_m = core::rotation(w.pose.heading_rad) * fix.antenna_robot_m;
  w.H.view().leftCols<2>().setIdentity();
  w.H.view().col(2) << -arm_world_m.y(), arm_world_m.x();
  w.R.view() = fix.covariance_m2;
  w.nu.view().col(0) = fix.position_world_m - w.pose.position_m() - arm_world_m;
}

void linearise_pairs(double sigma_m, UpdateWorkspace& w) {
  const Index rows = static_cast<Index>(w.landmark_of_row.size());
  size_rows(w, rows);
  w.R.view().diagonal().setConstant(sigma_m * sigma_m);
  for (Index row = 0; row < rows; row += 2) {
    const int kept = w.landmark_of_row[static_cast<std::size_t>(row)];
    const int removed = w.landmark_of_row[static_cast<std::size_t>(row) + 1];
    w.H.view().block<2, 2>(row, ActivePart::column(kept)).setIdentity();
    w.H.view().block<2, 2>(row, ActivePart::column(removed)).diagonal().setConstant(-1.0);
    w.nu.view().block<2, 1>(row, 0) =
        w.points_m[static_cast<std::size_t>(removed)] - w.points_m[static_cast<std::size_t>(kept)];
  }
}

bool is_wide(const UpdateWorkspace& w) { return w.H.cols() >= 512; }

std::vector<Nonzero> nonzeros_of(const ReservedMatrix& H) {
  std::vector<Nonzero> nonzeros;
  const auto h = H.view();
  for (Index row = 0; row < h.rows(); ++row) {
    for (Index column = 0; column < h.cols(); ++column) {
      if (h(row, column) != 0.0) nonzeros.push_back({row, column, h(row, column)});
    }
  }
  return nonzeros;
}

double solve_innovation(UpdateWorkspace& w, const char* verb) {
  factor_innovation(w, verb);
  w.gain.resize(w.H.cols(), 1);
  if (is_wide(w)) {
    Eigen::VectorXd lambda = w.y.view().col(0);
    w.L.view().triangularView<Eigen::Lower>().transpose().solveInPlace(lambda);
    w.gain.view().col(0).noalias() = w.H.view().transpose() * lambda;
  } else {
    w.G = w.H;
    solve_in_place(w.L, w.G);
    w.gain.view().noalias() = w.G.view().transpose().lazyProduct(w.y.view());
  }
  return w.y.view().squaredNorm();
}

}  // namespace helixnav::cekf
