// SPDX-License-Identifier: BSD-3-Clause
#include "noise/fix_noise.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::supervisor {
namespace {

/// Variances of white errors, in octaves of the stated one: so fine, and so small, that white errors between two of them, or
/// below what is stated, do not look like fading ones.
constexpr double least_octave = -4.0;
constexpr double most_octave = 6.0;
constexpr double white_step = 0.25;
/// Errors that fade are at least as large as stated: small ones cannot be told from the drift of the pose.
constexpr std::array<double, 3> fading_s = {5.0, 20.0, 80.0};
constexpr std::array<double, 2> shares = {0.5, 0.95};  ///< of the variance
constexpr double white_as_stated = 0.8;                ///< prior probabilities
constexpr double white_of_another_size = 0.1;
constexpr double fading_at_all = 0.1;
constexpr double memory_s = 300.0;  ///< a few of the longest times; no fewer than as many fixes are remembered, either
constexpr double keep_interval = 0.9;
/// An outlier may be anywhere, and says the same to all hypotheses.
constexpr double outliers = 0.01;
constexpr double outlier_variance = 256.0;
constexpr double most_beyond = 0.5;

double log_density(double squared, double variance) { return -std::log(variance) - 0.5 * squared / variance; }

}  // namespace

FixNoise::FixNoise() {
  auto next = hypotheses_.begin();
  constexpr double sizes = (most_octave - least_octave) / white_step;
  for (double octave = least_octave; octave <= most_octave; octave += white_step) {
    const double prior = octave == 0.0 ? white_as_stated : white_of_another_size / sizes;
    *next++ = {0.0, std::exp2(octave), 0.0, std::log(prior)};
  }
  const double each = fading_at_all / static_cast<double>(hypotheses_.end() - next);
  for (double octave = 0.0; octave <= most_octave; octave += 1.0)
    for (const double seconds : fading_s)
      for (const double share : shares)
        *next++ = {seconds, (1.0 - share) * std::exp2(octave), share * std::exp2(octave), std::log(each)};
}

void FixNoise::observe(const FixInnovation& fix, double most_nis, core::Nanoseconds t_ns) {
  const bool is_beyond = fix.innovation.squaredNorm() > most_nis * (fix.predicted_variance + of_one_);
  beyond_ += ((is_beyond ? 1.0 : 0.0) - beyond_) / memory_s;
  if (is_beyond && beyond_ < most_beyond) return;
  const double elapsed_s = begun_ ? std::max(0.0, core::seconds(t_ns - last_ns_)) : 0.0;
  const double drifted = std::max(0.0, fix.predicted_variance - variance_);
  const double keep = std::exp(-std::min(1.0, elapsed_s) / memory_s);
  for (Hypothesis& hypothesis : hypotheses_) {
    predict(hypothesis, elapsed_s, drifted);
    update(hypothesis, fix.innovation, keep);
  }
  if (elapsed_s > 0.0)
    interval_s_ = interval_s_ > 0.0 ? keep_interval * interval_s_ + (1.0 - keep_interval) * elapsed_s : elapsed_s;
  begun_ = true;
  last_ns_ = t_ns;
  variance_ = fix.predicted_variance;
  weigh();
}

void FixNoise::predict(Hypothesis& hypothesis, double elapsed_s, double drifted) const {
  if (!begun_) hypothesis.covariance(0, 0) = hypothesis.fading;
  const double kept = hypothesis.fading > 0.0 ? std::exp(-elapsed_s / hypothesis.fading_s) : 0.0;
  hypothesis.means.row(0) *= kept;
  hypothesis.covariance.row(0) *= kept;
  hypothesis.covariance.col(0) *= kept;
  hypothesis.covariance(0, 0) += hypothesis.fading * (1.0 - kept * kept);
  hypothesis.covariance(1, 1) += drifted;
}

/// One fix, both coordinates.
void FixNoise::update(Hypothesis& h, const Eigen::Vector2d& innovation, double keep) const {
  const Eigen::Vector2d with_fix = h.covariance.rowwise().sum();
  const double variance = with_fix.sum() + h.white;
  const Eigen::RowVector2d rest = innovation.transpose() - h.means.colwise().sum();
  const double squared = rest.squaredNorm();
  const double usual = std::log(1.0 - outliers) + log_density(squared, variance);
  const double unusual = std::log(outliers) + log_density(squared, outlier_variance);
  h.log_likelihood =
      keep * h.log_likelihood + std::max(usual, unusual) + std::log1p(std::exp(-std::abs(usual - unusual)));
  const Eigen::Vector2d gain = with_fix / variance;
  h.means += gain * rest;
  h.covariance -= gain * with_fix.transpose();
  h.covariance = 0.5 * (h.covariance + h.covariance.transpose()).eval();
}

/// Geometric means over the hypotheses; fixes are not believed to be better than they state.
void FixNoise::weigh() {
  double most = hypotheses_.front().log_likelihood;
  for (const Hypothesis& hypothesis : hypotheses_) most = std::max(most, hypothesis.log_likelihood);
  double sum = 0.0, one = 0.0, all = 0.0;
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.log_likelihood -= most;
    const double weight = std::exp(hypothesis.log_prior + hypothesis.log_likelihood);
    double as_white = hypothesis.white;
    if (hypothesis.fading > 0.0 && interval_s_ > 0.0) {
      const double kept = std::exp(-interval_s_ / hypothesis.fading_s);
      as_white += hypothesis.fading * (1.0 + kept) / (1.0 - kept);
    }
    sum += weight;
    one += weight * std::log(hypothesis.white + hypothesis.fading);
    all += weight * std::log(as_white);
  }
  of_one_ = std::max(1.0, std::exp(one / sum));
  in_update_ = std::max(1.0, std::exp(all / sum));
}

void FixNoise::note_correction(const FixInnovation& before, const FixInnovation& after) {
  const Eigen::RowVector2d moved = (before.innovation - after.innovation).transpose();
  for (Hypothesis& hypothesis : hypotheses_) hypothesis.means.row(1) -= moved;
  variance_ = after.predicted_variance;
}

void FixNoise::forget_offset() {
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.means.row(1).setZero();
    hypothesis.covariance.row(1).setZero();
    hypothesis.covariance.col(1).setZero();
  }
  variance_ = 0.0;
}

}  // namespace helixnav::supervisor
