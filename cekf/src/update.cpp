// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <sstream>

#include "checks.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {
namespace {

/// The common case of core::check_observation without its allocation; doubt is left to that function.
bool is_plainly_valid(const core::Observation& o) {
  const int d = core::dimension(o.kind);
  if (o.z.size() != d || o.R.rows() != d || o.R.cols() != d || !o.z.allFinite() || !o.R.allFinite()) return false;
  const bool has_range = o.kind == core::ObservationKind::range_bearing || o.kind == core::ObservationKind::range;
  if (has_range && o.z[0] <= 0.0) return false;
  if (!(o.R(0, 0) > 0.0)) return false;
  return d == 1 || (o.R(0, 1) == o.R(1, 0) && o.R(0, 0) * o.R(1, 1) - o.R(0, 1) * o.R(1, 0) > 0.0);
}

}  // namespace

std::string problem_with(const UpdateWorkspace& w, const char* verb, const char* what) {
  std::ostringstream problem;
  problem << verb << ": " << what << "; landmarks";
  for (const core::LandmarkId id : w.ids) problem << ' ' << id;
  return problem.str();
}

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

void CompressedEkf::check_matches(const std::vector<Match>& matches, const char* verb) const {
  for (const Match& match : matches) {
    place_of(match.landmark, verb);
    check_observation_of(match, verb);
  }
}

UpdateResult CompressedEkf::update(const std::vector<Match>& matches) {
  check_matches(matches, "update");
  if (matches.empty()) return {};
  for (const Match& match : matches) activate(match.landmark);
  UpdateWorkspace& w = workspace_;
  collect_columns(matches, w);
  linearise(matches, w);
  factor_innovation(w, "update");
  w.gain.resize(w.H.cols(), 1);
  w.gain.view().noalias() = w.G.view().transpose().lazyProduct(w.y.view());
  const double nis = w.y.view().squaredNorm();
  const int dof = static_cast<int>(w.H.rows());
  apply_correction(w, "update");
  return {nis, dof};
}

void CompressedEkf::collect_columns(const std::vector<Match>& matches, UpdateWorkspace& w) const {
  w.ids.clear();
  w.landmark_of_row.clear();
  for (const Match& match : matches) {
    auto found = std::find(w.ids.begin(), w.ids.end(), match.landmark);
    w.landmark_of_row.push_back(static_cast<int>(found - w.ids.begin()));
    if (found == w.ids.end()) w.ids.push_back(match.landmark);
  }
  gather_involved(w);
}

void CompressedEkf::gather_involved(UpdateWorkspace& w) const {
  w.involved.assign({0, 1, 2});
  w.points_m.clear();
  for (const core::LandmarkId id : w.ids) {
    const int index = places_[static_cast<std::size_t>(id)].index;
    w.involved.push_back(ActivePart::column(index));
    w.involved.push_back(ActivePart::column(index) + 1);
    w.points_m.push_back(active_.points_m[static_cast<std::size_t>(index)]);
  }
  w.pose = active_.pose;
  const Eigen::Index n = static_cast<Eigen::Index>(w.involved.size());
  w.P.resize(n, n);
  const auto P = active_.P.view();
  auto P_involved = w.P.view();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      P_involved(i, j) = P(w.involved[static_cast<std::size_t>(i)], w.involved[static_cast<std::size_t>(j)]);
    }
  }
}

void CompressedEkf::linearise(const std::vector<Match>& matches, UpdateWorkspace& w) const {
  Eigen::Index rows = 0;
  for (const Match& match : matches) rows += core::dimension(match.observation.kind);
  const Eigen::Index cols = static_cast<Eigen::Index>(w.involved.size());
  w.H.resize(rows, cols);
  w.R.resize(rows, rows);
  w.nu.resize(rows, 1);
  w.H.set_zero();
  w.R.set_zero();
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const core::Observation& z = matches[k].observation;
    const int landmark = w.landmark_of_row[k];
    const core::PredictedObservation predicted = core::predict_observation(
        z.kind, w.pose, matches[k].T_robot_sensor, w.points_m[static_cast<std::size_t>(landmark)]);
    const int d = core::dimension(z.kind);
    w.H.view().block(row, 0, d, 3) = predicted.H_pose;
    w.H.view().block(row, ActivePart::column(landmark), d, 2) = predicted.H_landmark;
    w.R.view().block(row, row, d, d) = z.R;
    w.nu.view().block(row, 0, d, 1) = core::innovation(z.kind, z.z, predicted.z_hat);
    row += d;
  }
}

void CompressedEkf::factor_innovation(UpdateWorkspace& w, const char* verb) const {
  const Eigen::Index m = w.H.rows();
  const Eigen::Index n = w.H.cols();
  w.G.resize(m, n);
  w.L.resize(m, m);
  w.y.resize(m, 1);
  auto G = w.G.view();
  auto L = w.L.view();
  G.noalias() = w.H.view().lazyProduct(w.P.view());
  L.noalias() = G.lazyProduct(w.H.view().transpose());
  L += w.R.view();
  // Cholesky of the lower triangle, column by column.
  bool positive = true;
  for (Eigen::Index j = 0; j < m && positive; ++j) {
    const double pivot = L(j, j) - L.row(j).head(j).squaredNorm();
    positive = pivot > 0.0 && std::isfinite(pivot);
    const double diagonal = std::sqrt(pivot);
    L(j, j) = diagonal;
    for (Eigen::Index i = j + 1; i < m; ++i) L(i, j) = (L(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / diagonal;
  }
  if (!positive)
    throw core::NumericalError(problem_with(w, verb, "the innovation covariance is not positive definite"));
  G = w.H.view();
  w.y.view() = w.nu.view();
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index k = 0; k < i; ++k) {
      G.row(i) -= L(i, k) * G.row(k);
      w.y.view()(i, 0) -= L(i, k) * w.y.view()(k, 0);
    }
    G.row(i) /= L(i, i);
    w.y.view()(i, 0) /= L(i, i);
  }
}

}  // namespace helixnav::cekf
