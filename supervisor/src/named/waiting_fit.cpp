// SPDX-License-Identifier: BSD-3-Clause
#include "named/waiting_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

using Index = Eigen::Index;

constexpr double most_noise_scale = 16.0;  // σ four times as assumed: beyond that something else is wrong

double largest_sigma(const Eigen::Matrix2d& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[1]);
}

double nearest_sensor_m(const std::vector<FitRow>& rows, const Eigen::Vector2d& point_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const FitRow& row : rows) nearest_m = std::min(nearest_m, (row.sensor.position_m() - point_m).norm());
  return nearest_m;
}

int free_rows(const std::vector<FitRow>& rows) { return static_cast<int>(rows.size()) - 2; }

bool has_rival(const std::vector<FittedPoint>& solutions, const DelayedOptions& options) {
  return solutions.size() > 1 && solutions[1].cost - solutions[0].cost < options.min_rival_margin;
}

bool is_contradicted(const std::vector<FitRow>& rows, const FittedPoint& best, const DelayedOptions& options) {
  return best.nis > core::chi2_quantile(options.fit_probability, free_rows(rows));
}

/// One sighting bore another landmark's name if all others agree without it and it is far off: two sightings and noise
/// do not do that.
OwnGuess guess_without_one(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P, double nis,
                           const DelayedOptions& options) {
  constexpr std::size_t least_others = 5;  // three more than place it
  constexpr double least_gain = 30.0;      // one in a thousand is wrong, somewhere in view
  OwnGuess guess;
  if (rows.size() <= least_others) return guess;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<FitRow> others = rows;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const std::vector<FittedPoint> solutions = fit_from_everywhere(others, P, options.spacing_m, options.same_m);
    if (solutions.empty() || has_rival(solutions, options)) continue;
    const FittedPoint& best = solutions.front();
    if (is_contradicted(others, best, options) || nis - best.nis < least_gain) continue;
    if (guess.wrong_row) return {};  // either of the two might be the wrong one
    guess = {best.point_m, i};
  }
  return guess;
}

/// Median over the landmarks of what their sightings are off by, per degree of freedom; 1 for few.
double noise_scale_of(const JointFit& fit) {
  constexpr std::size_t few = 3;
  if (fit.rows.size() < few) return 1.0;
  std::vector<double> ratios;
  for (std::size_t j = 0; j < fit.rows.size(); ++j) ratios.push_back(fit.misfit[j] / free_rows(fit.rows[j]));
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::clamp(*middle, 1.0, most_noise_scale);
}

/// The landmark that its sightings contradict most.
std::optional<std::size_t> worst_contradicted(const DeterminedLandmarks& found, const DelayedOptions& options) {
  std::optional<std::size_t> worst;
  double largest = 1.0;
  for (std::size_t j = 0; j < found.landmarks.size(); ++j) {
    const auto rows = static_cast<int>(found.landmarks[j].rows.size());
    const double excess =
        found.fit.misfit[j] / (found.noise_scale * core::chi2_quantile(options.fit_probability, rows));
    if (excess < largest) continue;
    largest = excess;
    worst = j;
  }
  return worst;
}

bool is_certain(const DeterminedLandmarks& found, std::size_t j, const DelayedOptions& options) {
  const double sigma_m = std::sqrt(found.noise_scale) * largest_sigma(found.fit.covariances_m2[j]);
  return sigma_m < options.max_relative_sigma * nearest_sensor_m(found.fit.rows[j], found.fit.points_m[j]);
}

/// By its own sightings, from the places as they are known without them: places that were fitted with the landmark at a
/// mirror image confirm the mirror image.
bool is_unique(const DeterminedLandmarks& found, std::size_t j, const Eigen::MatrixXd& P,
               const DelayedOptions& options) {
  const std::vector<FittedPoint> alone =
      fit_from_everywhere(found.landmarks[j].rows, P, options.spacing_m, options.same_m);
  if (alone.empty() || has_rival(alone, options)) return false;
  const auto distance_m = [&](const FittedPoint& solution) {
    return (solution.point_m - found.fit.points_m[j]).norm();
  };
  return std::all_of(alone.begin(), alone.end(),
                     [&](const FittedPoint& solution) { return distance_m(alone.front()) <= distance_m(solution); });
}

bool is_gaussian(const DeterminedLandmarks& found, std::size_t j, const DelayedOptions& options) {
  const std::vector<FitRow>& rows = found.fit.rows[j];
  const Eigen::MatrixXd& P = found.fit.place_covariance;
  const std::optional<FittedPoint> fitted = fit_point(rows, P, found.fit.points_m[j], options.same_m);
  return fitted && looks_gaussian(rows, P, *fitted);
}

template <class Keep>
bool leave_out(std::vector<WaitingLandmark>& landmarks, const Keep& keep) {
  std::vector<WaitingLandmark> kept;
  for (std::size_t j = 0; j < landmarks.size(); ++j) {
    if (keep(j)) kept.push_back(landmarks[j]);
  }
  std::swap(landmarks, kept);
  return landmarks.size() < kept.size();
}

/// Fits all together. False if that is not possible; then none is left.
bool fit_all(DeterminedLandmarks& found, const Eigen::MatrixXd& P) {
  std::vector<std::vector<FitRow>> rows;
  std::vector<Eigen::Vector2d> starts_m;
  for (const WaitingLandmark& landmark : found.landmarks) {
    rows.push_back(landmark.rows);
    starts_m.push_back(*landmark.guess_m);
  }
  std::optional<JointFit> fit = fit_jointly(rows, P, starts_m);
  if (fit) {
    found.fit = std::move(*fit);
    found.noise_scale = noise_scale_of(found.fit);
    return true;
  }
  for (const WaitingLandmark& landmark : found.landmarks) found.contradicted.push_back(landmark.identity);
  found.landmarks.clear();
  return false;
}

bool drop_contradicted(DeterminedLandmarks& found, const DelayedOptions& options) {
  const std::optional<std::size_t> worst = worst_contradicted(found, options);
  if (!worst) return false;
  found.contradicted.push_back(found.landmarks[*worst].identity);
  return leave_out(found.landmarks, [&](std::size_t j) { return j != *worst; });
}

void mark_entering(DeterminedLandmarks& found, const Eigen::MatrixXd& P, const DelayedOptions& options) {
  for (std::size_t j = 0; j < found.landmarks.size(); ++j) {
    found.landmarks[j].enters =
        is_certain(found, j, options) && is_gaussian(found, j, options) && is_unique(found, j, P, options);
  }
}

int entering(const DeterminedLandmarks& found) {
  return static_cast<int>(std::count_if(found.landmarks.begin(), found.landmarks.end(),
                                        [](const WaitingLandmark& landmark) { return landmark.enters; }));
}

}  // namespace

OwnGuess guess_alone(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P, const DelayedOptions& options) {
  constexpr std::size_t least_rows = 4;
  if (rows.size() < least_rows) return {};
  const std::vector<FittedPoint> solutions = fit_from_everywhere(rows, P, options.spacing_m, options.same_m);
  if (solutions.empty()) return {};
  const FittedPoint& best = solutions.front();
  if (options.names_may_be_wrong && is_contradicted(rows, best, options)) {
    const OwnGuess without_one = guess_without_one(rows, P, best.nis, options);
    if (without_one.point_m) return without_one;
  }
  if (has_rival(solutions, options) || best.nis > most_noise_scale * free_rows(rows)) return {};
  return {best.point_m, std::nullopt};
}

DeterminedLandmarks determined(std::vector<WaitingLandmark> waiting, const Eigen::MatrixXd& P,
                               const DelayedOptions& options) {
  constexpr int least_together = 2;
  DeterminedLandmarks found;
  found.landmarks = std::move(waiting);
  std::optional<DeterminedLandmarks> with_help;
  while (!found.landmarks.empty() && fit_all(found, P)) {
    if (drop_contradicted(found, options)) continue;
    mark_entering(found, P, options);
    if (!with_help) with_help = found;
    if (!leave_out(found.landmarks, [&](std::size_t j) { return found.landmarks[j].enters; })) break;
  }
  if (!found.landmarks.empty() || !with_help || entering(*with_help) < least_together) return found;
  with_help->contradicted = found.contradicted;
  return *with_help;
}

cekf::PointRows rows_about_places(const DeterminedLandmarks& found, const SensorPlaces& places) {
  const Index columns = places.by_map.cols() - 3;  // what is seen from several places does not depend on the pose now
  Eigen::MatrixXd stacked(0, columns + 1);
  for (std::size_t j = 0; j < found.landmarks.size(); ++j) {
    const std::vector<FitRow>& rows = found.fit.rows[j];
    const WhitenedRows white = *whiten(rows, found.fit.points_m[j]);
    const auto size = static_cast<Index>(rows.size());
    Eigen::MatrixXd all(size, columns + 1);
    for (Index i = 0; i < size; ++i) {
      const Index first = rows[static_cast<std::size_t>(i)].first;
      all.row(i).head(columns) = white.by_place.row(i) * places.by_map.block(first, 3, 3, columns);
      all(i, columns) = white.residual[i] + white.by_place.row(i).dot(found.fit.moved.segment<3>(first));
    }
    const Eigen::MatrixXd turned =
        Eigen::HouseholderQR<Eigen::MatrixXd>(white.by_point).householderQ().transpose() * all;
    const Index had = stacked.rows();
    stacked.conservativeResize(had + size - 2, Eigen::NoChange);
    stacked.bottomRows(size - 2) = turned.bottomRows(size - 2) / std::sqrt(found.noise_scale);
  }
  if (stacked.rows() > columns) {
    const Eigen::MatrixXd upper = Eigen::HouseholderQR<Eigen::MatrixXd>(stacked).matrixQR().topRows(columns);
    stacked = upper.triangularView<Eigen::Upper>();
  }
  return {places.joint.ids, stacked.leftCols(columns), stacked.col(columns)};
}

std::optional<cekf::DerivedPoint> derived_from_places(const std::vector<FitRow>& rows, const Eigen::Vector2d& near_m,
                                                      const SensorPlaces& places, double same_m) {
  const Eigen::MatrixXd certain = Eigen::MatrixXd::Zero(places.covariance.rows(), places.covariance.cols());
  const std::optional<FittedPoint> fitted = fit_point(rows, certain, near_m, same_m);
  if (!fitted || !fitted->covariance_m2.allFinite()) return std::nullopt;
  const WhitenedRows white = *whiten(rows, fitted->point_m);
  const Eigen::MatrixXd gain = fitted->covariance_m2 * white.by_point.transpose();
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(2, places.by_map.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = static_cast<Index>(i);
    G -= gain.col(row) * (white.by_place.row(row) * places.by_map.middleRows<3>(rows[i].first));
  }
  const Eigen::Matrix2d R_world_robot = core::rotation(places.joint.pose.heading_rad);
  const Eigen::Vector2d arm_m = R_world_robot * fitted->point_m;
  cekf::DerivedPoint point;
  point.point_m = places.joint.pose.position_m() + arm_m;
  point.ids = places.joint.ids;
  point.G = R_world_robot * G;
  point.G.leftCols<2>() += Eigen::Matrix2d::Identity();
  point.G.col(2) += Eigen::Vector2d(-arm_m.y(), arm_m.x());
  const Eigen::Matrix2d noise = R_world_robot * fitted->covariance_m2 * R_world_robot.transpose();
  point.noise_m2 = 0.5 * (noise + noise.transpose());
  return point;
}

}  // namespace helixnav::supervisor
