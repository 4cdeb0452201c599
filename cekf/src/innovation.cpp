// SPDX-License-Identifier: BSD-3-Clause
#include "innovation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "helixnav/cekf/active_part.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::cekf {
namespace {

using Index = Eigen::Index;

/// The common case of core::check_observation without its allocation; doubt is left to that function.
bool is_plainly_valid(const core::Observation& o) {
  const int d = core::dimension(o.kind);
  if (o.z.size() != d || o.R.rows() != d || o.R.cols() != d || !o.z.allFinite() || !o.R.allFinite()) return false;
  const bool has_range = o.kind == core::ObservationKind::range_bearing || o.kind == core::ObservationKind::range;
  if (has_range && o.z[0] <= 0.0) return false;
  if (!(o.R(0, 0) > 0.0)) return false;
  return d == 1 || (o.R(0, 1) == o.R(1, 0) && o.R(0, 0) * o.R(1, 1) - o.R(0, 1) * o.R(1, 0) > 0.0);
}

void size_rows(UpdateWorkspace& w, Index rows) {
  w.H.resize(rows, static_cast<Index>(w.involved.size()));
  w.R.resize(rows, rows);
  w.nu.resize(rows, 1);
  w.H.set_zero();
  w.R.set_zero();
}

/// Lower Cholesky factor in place; false when a pivot is not positive.
template <class Matrix>
bool factor_in_place(Matrix& L) {
  for (Index j = 0; j < L.rows(); ++j) {
    const double pivot = L(j, j) - L.row(j).head(j).squaredNorm();
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double diagonal = std::sqrt(pivot);
    L(j, j) = diagonal;
    for (Index i = j + 1; i < L.rows(); ++i) {
      L(i, j) = (L(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / diagonal;
    }
  }
  return true;
}

}  // namespace

void check_observation_of(const Match& match, const char* verb) {
  if (is_plainly_valid(match.observation) && match.T_robot_sensor.vector().allFinite()) return;
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
  if (fix.position_world_m.allFinite() && fix.antenna_robot_m.allFinite() &&
      core::is_symmetric_positive_definite(fix.covariance_m2)) {
    return;
  }
  std::ostringstream problem;
  problem << verb << ": the fix at t_ns = " << fix.t_ns << " is not finite or its covariance not positive definite";
  throw core::PreconditionError(problem.str());
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

double solve_innovation(UpdateWorkspace& w, const char* verb) {
  const Index m = w.H.rows();
  const Index n = w.H.cols();
  w.G.resize(m, n);
  w.L.resize(m, m);
  w.y.resize(m, 1);
  w.gain.resize(n, 1);
  auto G = w.G.view();
  auto L = w.L.view();
  auto y = w.y.view();
  G.noalias() = w.H.view().lazyProduct(w.P.view());
  L.noalias() = G.lazyProduct(w.H.view().transpose());
  L += w.R.view();
  if (!factor_in_place(L)) {
    throw core::NumericalError(problem_with(w, verb, "the innovation covariance is not positive definite"));
  }
  G = w.H.view();
  y = w.nu.view();
  for (Index i = 0; i < m; ++i) {
    for (Index k = 0; k < i; ++k) {
      G.row(i) -= L(i, k) * G.row(k);
      y(i, 0) -= L(i, k) * y(k, 0);
    }
    G.row(i) /= L(i, i);
    y(i, 0) /= L(i, i);
  }
  w.gain.view().noalias() = G.transpose().lazyProduct(y);
  return y.squaredNorm();
}

}  // namespace helixnav::cekf
