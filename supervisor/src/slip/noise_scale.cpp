// SPDX-License-Identifier: BSD-3-Clause
#include "slip/noise_scale.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace helixnav::supervisor {
namespace {

constexpr double prior_dof = 60.0;      // of the belief that the noise is as claimed
constexpr double prior_weight = 8.0;    // likewise, scans in which odometry's is all that there is
constexpr double most_pose_nis = 16.3;  // χ²₃ of 99.9 %: a slip is no noise
constexpr double dead_band = 1.35;
constexpr double most = 25.0;
constexpr double sure_sigmas = 3.0;  // before a quick change is believed
constexpr double keep_mean = 1.0 - 1.0 / 100.0;

double applied(double scale) { return scale < dead_band ? 1.0 : std::min(scale, most); }

}  // namespace

double NoiseScale::Window::observations() const { return (prior_dof + rest) / (prior_dof + rest_dof); }
double NoiseScale::Window::odometry() const { return (prior_weight + excess) / (prior_weight + excess_weight); }

void NoiseScale::observe(const PairEquations& pairs, const Eigen::Matrix3d& Q) {
  constexpr Eigen::Index least_rows = 6;
  if (pairs.nu.size() < least_rows) return;
  const Eigen::LLT<Eigen::MatrixXd> S(pairs.S);
  if (S.info() != Eigen::Success) return;
  const Eigen::VectorXd weighed = S.solve(pairs.nu);
  const Eigen::Matrix3d information = pairs.A.transpose() * S.solve(pairs.A);
  const Eigen::LLT<Eigen::Matrix3d> root(information);
  if (root.info() != Eigen::Success) return;
  const Eigen::Vector3d w = root.matrixL().solve(pairs.A.transpose() * weighed);
  const double rest = std::max(0.0, pairs.nu.dot(weighed) - w.squaredNorm());
  const double pose = std::min(most_pose_nis, (w - mean_).squaredNorm() / (1.0 + 1.0 / mean_weight_));
  mean_weight_ = keep_mean * mean_weight_ + 1.0;
  mean_ += (w - mean_) / mean_weight_;
  const double share = std::clamp((Q * information).trace() / 3.0, 0.0, 1.0);  // odometry's of w's variance
  for (Window* window : {&slow_, &quick_}) {
    window->rest = window->keep * window->rest + observations_ * rest;
    window->rest_dof = window->keep * window->rest_dof + static_cast<double>(pairs.nu.size() - 3);
    window->excess = window->keep * window->excess + odometry_ * (share * share + share * (pose / 3.0 - 1.0));
    window->excess_weight = window->keep * window->excess_weight + share * share;
  }
  choose();
}

/// Slow, but for a rise that the quick window is sure of.
void NoiseScale::choose() {
  const auto sure = [](double scale, double dof) { return scale * (1.0 - sure_sigmas * std::sqrt(2.0 / dof)); };
  observations_ = applied(std::max(slow_.observations(), sure(quick_.observations(), prior_dof + quick_.rest_dof)));
  const double samples = 3.0 * (prior_weight + quick_.excess_weight);
  odometry_ = applied(std::max(slow_.odometry(), sure(quick_.odometry(), samples)));
}

}  // namespace helixnav::supervisor
