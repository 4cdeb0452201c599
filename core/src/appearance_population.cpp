// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/map_appearance.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "helixnav/core/chi2.hpp"

namespace helixnav::core {
namespace {

using Vote = LandmarkAppearance::Vote;

/// Least variance of the sizes of a population, as a share of the square of their mean: of things that are all alike.
constexpr double least_spread = 1e-4;

/// ln N(d; 0, variance) except for −½ ln 2π, which all densities of a size have.
double ln_normal(double difference, double variance) {
  return -0.5 * (std::log(variance) + difference * difference / variance);
}

/// ln(eᵃ + eᵇ), however large they are; a is finite.
double ln_sum(double a, double b) {
  const double larger = std::max(a, b);
  return larger + std::log1p(std::exp(std::min(a, b) - larger));
}

bool is_before(const std::pair<ClassName, std::size_t>& one, const ClassName& name) { return one.first < name; }

}  // namespace

void AppearancePopulation::count(const Appearance& seen) {
  if (!seen.name.empty()) {
    const auto at = std::lower_bound(classes_.begin(), classes_.end(), seen.name, is_before);
    const bool known = at != classes_.end() && at->first == seen.name;
    if (known) {
      ++at->second;
    } else if (classes_.size() < most_classes) {
      classes_.insert(at, {seen.name, 1});
    }
    ++given_;
  }
  if (!(seen.size_m > 0.0)) return;
  ++sizes_;
  const double off_m = seen.size_m - size_mean_m_;
  size_mean_m_ += off_m / static_cast<double>(sizes_);
  size_squares_m2_ += off_m * (seen.size_m - size_mean_m_);
}

void AppearancePopulation::learn_size_noise(const LandmarkAppearance& known, const Appearance& seen) {
  if (!(known.size_m > 0.0) || !(seen.size_m > 0.0)) return;
  constexpr double most_looks = 300.0;
  constexpr double most = 100.0;
  const double nothing = says_nothing(known, seen);
  outlier_looks_ = std::min(most_looks, outlier_looks_ + 1.0);
  outliers_ += (nothing - outliers_) / outlier_looks_;
  const double variance = known.size_variance_m2 + size_noise_ * seen.sigma_size_m * seen.sigma_size_m;
  const double off_m = seen.size_m - known.size_m;
  size_looks_ = std::min(most_looks, size_looks_ + 1.0);
  size_noise_ *= 1.0 + (1.0 - nothing) * (off_m * off_m / variance - 1.0) / size_looks_;
  size_noise_ = std::clamp(size_noise_, 1.0 / most, most);
}

double AppearancePopulation::size_outliers() const {
  constexpr double least = 0.001;
  constexpr double most = 0.3;
  return sizes_ >= enough_sizes ? std::clamp(outliers_, least, most) : 0.0;
}

double AppearancePopulation::size_variance_m2(const Appearance& seen) const {
  return size_noise() * seen.sigma_size_m * seen.sigma_size_m;
}

/// P(the size is as that of any object), of one that was matched.
double AppearancePopulation::says_nothing(const LandmarkAppearance& known, const Appearance& seen) const {
  const double outliers = size_outliers();
  if (!(outliers > 0.0) || !(known.size_m > 0.0)) return 0.0;
  const double variance = size_variance_m2(seen);
  const double of_landmark = ln_normal(seen.size_m - known.size_m, known.size_variance_m2 + variance);
  const double odds = (1.0 - outliers) / outliers * std::exp(of_landmark - ln_density(seen.size_m, variance));
  return 1.0 / (1.0 + odds);
}

double AppearancePopulation::size_noise() const {
  constexpr double dead_band = 1.35;
  constexpr double sure = 3.0;
  const double least = std::max(std::log(dead_band), sure * std::sqrt(2.0 / size_looks_));
  return std::log(size_noise_) > least ? size_noise_ : 1.0;
}

double AppearancePopulation::share(const ClassName& name) const {
  const auto at = std::lower_bound(classes_.begin(), classes_.end(), name, is_before);
  const double seen = at != classes_.end() && at->first == name ? static_cast<double>(at->second) : 0.0;
  return (seen + 1.0) / (static_cast<double>(given_ + classes_.size()) + 2.0);
}

double AppearancePopulation::ln_density(double size_m, double variance_m2) const {
  const double spread_m2 =
      std::max(size_squares_m2_ / static_cast<double>(sizes_), least_spread * size_mean_m_ * size_mean_m_);
  return ln_normal(size_m - size_mean_m_, spread_m2 + variance_m2);
}

LandmarkAppearance AppearancePopulation::updated(const LandmarkAppearance& known, const Appearance& seen) const {
  LandmarkAppearance now = known;
  if (!seen.name.empty()) {
    const double odds = (1.0 - seen.class_error) / (seen.class_error * share(seen.name));
    now.add_vote(seen.name, std::log1p(odds));
  }
  if (seen.size_m > 0.0) now.add_size(seen.size_m, size_variance_m2(seen), says_nothing(known, seen));
  return now;
}

/// P(the landmark is of that class): what its votes and the shares of the population say together.
double AppearancePopulation::probability(const LandmarkAppearance& known, const ClassName& name) const {
  double others = 1.0;
  double total = 0.0;
  double own = share(name);
  for (const Vote& vote : known.votes) {
    if (vote.name.empty()) continue;
    const double of_all = share(vote.name);
    const double weight = of_all * std::exp(vote.nats);
    others -= of_all;
    total += weight;
    if (vote.name == name) own = weight;
  }
  return own / (total + std::max(0.0, others));
}

/// P(the landmark is of a class that it is likelier to be of than this one).
double AppearancePopulation::likelier(const LandmarkAppearance& known, const ClassName& than) const {
  const double limit = probability(known, than);
  double sum = 0.0;
  for (const Vote& vote : known.votes) {
    if (vote.name.empty() || vote.name == than) continue;
    const double one = probability(known, vote.name);
    if (one > limit) sum += one;
  }
  return sum;
}

/// ln Σ_k P(one is k) P(other is k)/q_k. What is left of a posterior for classes without votes is spread by their shares.
double AppearancePopulation::ln_alike(const LandmarkAppearance& one, const LandmarkAppearance& other) const {
  std::array<ClassName, std::tuple_size<decltype(one.votes)>::value * 2> names;
  auto end = names.begin();
  for (const LandmarkAppearance* side : {&one, &other}) {
    for (const Vote& vote : side->votes) {
      if (!vote.name.empty() && std::find(names.begin(), end, vote.name) == end) *end++ = vote.name;
    }
  }
  double rest = 1.0;
  double alike = 0.0;
  for (auto name = names.begin(); name != end; ++name) {
    rest -= share(*name);
    alike += probability(one, *name) * probability(other, *name) / share(*name);
  }
  const double without_votes = share(ClassName());
  const double density_one = probability(one, ClassName()) / without_votes;
  const double density_other = probability(other, ClassName()) / without_votes;
  return std::log(alike + std::max(0.0, rest) * density_one * density_other);
}

AppearanceEvidence AppearancePopulation::compare_sizes(const LandmarkAppearance& known, double size_m,
                                                       double variance_m2, double outliers) const {
  AppearanceEvidence evidence;
  if (!(known.size_m > 0.0) || !(size_m > 0.0)) return evidence;
  const double variance = known.size_variance_m2 + variance_m2;
  const double off_m = size_m - known.size_m;
  evidence.size_nis = off_m * off_m / variance;
  evidence.size_dof = 1;
  if (sizes_ < enough_sizes) return evidence;
  const double of_any = ln_density(size_m, variance_m2);
  const auto nats = [&](double m) {
    const double of_landmark = ln_normal(m, variance) - of_any;
    return outliers > 0.0 ? ln_sum(std::log1p(-outliers) + of_landmark, std::log(outliers)) : of_landmark;
  };
  evidence.nats = nats(off_m);
  if (outliers > 0.0) evidence.size_nis = 2.0 * (nats(0.0) - nats(off_m));
  return evidence;
}

AppearanceEvidence AppearancePopulation::compare(const LandmarkAppearance& known, const Appearance& seen) const {
  AppearanceEvidence evidence = compare_sizes(known, seen.size_m, size_variance_m2(seen), size_outliers());
  if (seen.name.empty() || known.votes.front().name.empty()) return evidence;
  const double sure = 1.0 - seen.class_error;
  evidence.nats += std::log(sure * probability(known, seen.name) / share(seen.name) + seen.class_error);
  evidence.gate = -2.0 * std::log1p(-sure * likelier(known, seen.name));
  return evidence;
}

AppearanceEvidence AppearancePopulation::compare(const LandmarkAppearance& one, const LandmarkAppearance& other) const {
  AppearanceEvidence evidence = compare_sizes(one, other.size_m, other.size_variance_m2, 0.0);
  if (one.votes.front().name.empty() || other.votes.front().name.empty()) return evidence;
  const double alike = ln_alike(one, other);
  evidence.nats += alike;
  evidence.gate = std::max(0.0, -2.0 * alike);
  return evidence;
}

bool AppearancePopulation::look_alike(const LandmarkAppearance& one, const LandmarkAppearance& other) const {
  static const double by_class = chi2_quantile(0.999, 2);
  static const double by_size = chi2_quantile(0.999, 1);
  const AppearanceEvidence evidence = compare(one, other);
  return evidence.gate < by_class && evidence.size_nis < by_size;
}

}  // namespace helixnav::core
