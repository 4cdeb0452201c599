// SPDX-License-Identifier: BSD-3-Clause
#include "noise/noise_scale.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {
namespace {

using Eigen::Index;

constexpr double prior_errors = 20.0;   // of the belief that the detector is as assumed
constexpr double most_pose_nis = 16.3;  // χ²₃ of 99.9 %: a slip is not noise
constexpr double least_weight = 2.0;    // scans in which odometry's share is all that there is
constexpr double least_errors = 4.0;    // errors, before more noise is believed: three pairs of a scan may all be wrong
constexpr double least_independent = 20.0;  // pairs from new sides, before less noise is believed
constexpr double dead_band = 1.35;
constexpr double most = 25.0;
constexpr double sure_sigmas = 3.0;
constexpr double keep_mean = 1.0 - 1.0 / 100.0;

/// A factor not yet in force has to be sure; one in force only has to be likelier than none.
double most_sigmas(double in_force) { return in_force == 1.0 ? sure_sigmas : 1.0; }

double bounded(double factor) { return std::clamp(factor, 1.0 / most, most); }

/// The displacement that the pairs show.
struct Displaced {
  Eigen::Vector3d by;
  Eigen::Matrix3d information;
  Eigen::Vector3d w;   ///< normalised
  double share = 0.0;  ///< of odometry in its covariance
};

std::optional<Displaced> displaced_by(const PairEquations& pairs, const Eigen::Matrix3d& Q) {
  constexpr Index least_rows = 6;
  if (pairs.nu.size() < least_rows) return std::nullopt;
  const Eigen::LLT<Eigen::MatrixXd> S(pairs.S);
  if (S.info() != Eigen::Success) return std::nullopt;
  const Eigen::Matrix3d information = pairs.A.transpose() * S.solve(pairs.A);
  const Eigen::LLT<Eigen::Matrix3d> root(information);
  if (root.info() != Eigen::Success) return std::nullopt;
  const Eigen::Vector3d weighed = pairs.A.transpose() * S.solve(pairs.nu);
  return Displaced{root.solve(weighed), information, root.matrixL().solve(weighed),
                   std::clamp((Q * information).trace() / 3.0, 0.0, 1.0)};
}

PairEquations fair_ones(PairEquations pairs, const std::vector<Look>& looks) {
  Index kept = 0;
  std::vector<Index> rows;
  for (std::size_t k = 0; k < looks.size(); ++k) {
    if (!looks[k].is_fair) continue;
    rows.insert(rows.end(), {2 * static_cast<Index>(k), 2 * static_cast<Index>(k) + 1});
  }
  for (const Index row : rows) {
    pairs.nu(kept) = pairs.nu(row);
    pairs.A.row(kept) = pairs.A.row(row);
    ++kept;
  }
  pairs.nu.conservativeResize(kept);
  pairs.A.conservativeResize(kept, 3);
  pairs.S = Eigen::MatrixXd(pairs.S(rows, rows));
  return pairs;
}

}  // namespace

/// E[nis / 3] = share · q + (1 − share) · detector for motion whose noise is q times the assumed noise.
void NoiseScale::Displacements::add(double nis, double share, double detector, double in_force) {
  sum = keep * sum + in_force * share * (nis / 3.0 - (1.0 - share) * detector);
  weight = keep * weight + share * share;
  shares = keep * shares + share;
}

double NoiseScale::Displacements::scale() const { return weight > least_weight ? sum / weight : 1.0; }
double NoiseScale::Displacements::sigma() const { return std::sqrt(2.0 / 3.0 / weight); }

double NoiseScale::Displacements::sure_rise(double sigmas, double log_sigma) const {
  constexpr double least = 0.1;  // scans in which odometry's share is all that there is
  if (!(weight > least)) return 1.0;
  const double rise = sum / weight;
  return rise > 1.0 + sigmas * std::hypot(sigma(), log_sigma * shares / weight) ? rise : 1.0;
}

void NoiseScale::observe(const PairEquations& pairs, const std::vector<Look>& looks, double heading_rad,
                         const Eigen::Matrix3d& Q) {
  const std::optional<Displaced> displaced = displaced_by(pairs, Q);
  if (!displaced) return;
  add_rest(pairs, displaced->by, displaced->information, looks, heading_rad);
  add_displacement(displaced->w, displaced->share);
  const bool are_all_fair = std::all_of(looks.begin(), looks.end(), [](const Look& look) { return look.is_fair; });
  const std::optional<Displaced> fair = are_all_fair ? displaced : displaced_by(fair_ones(pairs, looks), Q);
  if (fair) add_fair_displacement(fair->w, fair->share);
  const double detector = detector_factor();
  odometry_ = odometry_factor();
  observations_ = detector;
}

/// What no displacement explains, from the pairs: e = ν − Aδ with covariance S − A(AᵀS⁻¹A)⁻¹Aᵀ.
void NoiseScale::add_rest(const PairEquations& pairs, const Eigen::Vector3d& displacement,
                          const Eigen::Matrix3d& information, const std::vector<Look>& looks, double heading_rad) {
  const Index rows = pairs.nu.size();
  const Eigen::Matrix3d of_displacement = information.inverse();
  const Eigen::VectorXd rest = pairs.nu - pairs.A * displacement;
  const double weight = static_cast<double>(rows - 3) / static_cast<double>(rows);  // they are not independent
  const Eigen::Matrix2d to_world = core::rotation(heading_rad);
  for (FadingErrors* errors : {&slow_, &quick_, &new_sides_}) errors->fade();
  repeated_.next_scan();
  for (Index i = 0; i < rows / 2; ++i) {
    const auto A = pairs.A.middleRows<2>(2 * i);
    const Eigen::Matrix2d covariance = pairs.S.block<2, 2>(2 * i, 2 * i) - A * of_displacement * A.transpose();
    const Eigen::LLT<Eigen::Matrix2d> factor(to_world * covariance * to_world.transpose());
    if (factor.info() != Eigen::Success) continue;
    const Eigen::Vector2d error =
        std::sqrt(observations_) * factor.matrixL().solve(to_world * Eigen::Vector2d(rest.segment<2>(2 * i)));
    const double squared = error.squaredNorm();
    const Look& look = looks[static_cast<std::size_t>(i)];
    slow_.add(squared, weight);
    quick_.add(squared, weight);
    if (!look.is_fair) continue;
    if (look.is_new_side) new_sides_.add(squared, weight);
    repeated_.add(look.id, error);
  }
}

double NoiseScale::detector_seen() const {
  const double credible = slow_.weight() / (slow_.weight() + prior_errors);
  return std::pow(slow_.scale(), credible) / observations_;
}

void NoiseScale::add_displacement(const Eigen::Vector3d& w, double share) {
  const double about_mean = (w - mean_).squaredNorm() / (1.0 + 1.0 / mean_weight_);
  mean_weight_ = keep_mean * mean_weight_ + 1.0;
  mean_ += (w - mean_) / mean_weight_;
  const double detector = detector_seen();
  slow_motion_.add(std::min(most_pose_nis, about_mean), share, std::max(1.0, detector), odometry_);
  quick_motion_.add(std::min(most_pose_nis, about_mean), share, std::max(1.0, detector), odometry_);
  biased_motion_.add(std::min(most_pose_nis, w.squaredNorm()), share, detector, odometry_);
}

void NoiseScale::add_fair_displacement(const Eigen::Vector3d& w, double share) {
  fair_motion_.add(std::min(most_pose_nis, w.squaredNorm()), share, detector_seen(), odometry_);
}

/// Up from all errors, at once if the quick window is sure of the rise. Down only if independent errors confirm it.
double NoiseScale::detector_factor() const {
  const double sigmas = most_sigmas(observations_);
  const bool is_enough = quick_.weight() >= least_errors;
  const double rise = is_enough ? std::log(quick_.scale()) - sure_sigmas * quick_.log_sigma() : 0.0;
  const double slow = std::log(slow_.scale());
  const double up = std::max(rise, is_enough && slow > sigmas * slow_.log_sigma() ? slow : 0.0);
  if (up > std::log(dead_band)) return bounded(std::exp(up));
  const double independent = std::log(new_sides_.scale());
  const double sigma = new_sides_.log_sigma();
  if (!(independent < -std::max(std::log(dead_band), sigmas * sigma))) return 1.0;
  if (std::min(new_sides_.weight(), repeated_.weight()) < least_independent || !motion_is_as_assumed_at_most())
    return 1.0;
  return bounded(
      std::min(1.0, std::max({std::exp(slow), slow_.mean_scale(), std::exp(independent - sigma), repeated_.scale()})));
}

/// If displacements are larger than odometry and such a detector explain, the detector errs for all landmarks alike,
/// and its errors are not white. A factor not yet in force needs more: withdrawn and believed again in turn, it would
/// have the whole drive solved again each time.
bool NoiseScale::motion_is_as_assumed_at_most() const {
  const double doubt = observations_ < 1.0 ? -biased_motion_.sigma() : 0.0;
  return biased_motion_.weight > least_weight && biased_motion_.scale() + doubt < dead_band;
}

/// Unless the displacements have a mean: then what the detector hides may be a bias.
double NoiseScale::hidden_rise(double sigmas) const {
  const double rise = slow_motion_.sure_rise(sigmas, slow_.log_sigma());
  return biased_motion_.sum < dead_band * slow_motion_.sum ? rise : 1.0;
}

/// Likewise; down by what is left including the mean, and never by more than it is sure of: the little that odometry
/// has moved in a few scans may seem to be less than nothing, and 25 times less variance was believed and withdrawn in
/// turn, with the drive solved again each time.
double NoiseScale::odometry_factor() const {
  const double sigmas = most_sigmas(odometry_);
  const double rise = quick_motion_.scale() * (1.0 - sure_sigmas * quick_motion_.sigma());
  const double slow = slow_motion_.scale();
  const double up = std::max({rise, slow > 1.0 + sigmas * slow_motion_.sigma() ? slow : 1.0, hidden_rise(sigmas)});
  if (up > dead_band) return bounded(up);
  if (!(fair_motion_.weight > least_weight)) return 1.0;
  const double with_mean = std::max(0.0, fair_motion_.scale()) + fair_motion_.sigma();
  const bool is_less = with_mean < 1.0 / dead_band && with_mean < 1.0 - (sigmas - 1.0) * fair_motion_.sigma();
  return is_less ? bounded(with_mean) : 1.0;
}

}  // namespace helixnav::supervisor
