// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/map_appearance.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::core {
namespace {

constexpr int class_count = 4;
const char* const class_names[class_count] = {"oak", "elm", "yew", "fir"};

Appearance given(const std::string& name, double class_error = 0.1) {
  Appearance seen;
  seen.name = ClassName(name);
  seen.class_error = class_error;
  return seen;
}

Appearance sized(double size_m, double sigma_m) {
  Appearance seen;
  seen.size_m = size_m;
  seen.sigma_size_m = sigma_m;
  return seen;
}

/// So many of each that a few more change nothing.
AppearancePopulation large_population() {
  AppearancePopulation population;
  for (int k = 0; k < class_count; ++k) {
    for (int i = 0; i < 1000 * (k + 1); ++i) population.count(given(class_names[k]));
  }
  return population;
}

/// p(all that was reported | each class), times its share, by definition.
std::vector<double> enumerated(const AppearancePopulation& population, const std::vector<Appearance>& seen) {
  std::vector<double> weights;
  for (const char* name : class_names) {
    double weight = population.share(ClassName(name));
    for (const Appearance& one : seen) {
      const double share = population.share(one.name);
      const bool same = one.name == ClassName(name);
      weight *= (same ? 1.0 - one.class_error : 0.0) + one.class_error * share;
    }
    weights.push_back(weight);
  }
  return weights;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum;
}

std::vector<Appearance> drawn(RandomStream& random, int count) {
  std::vector<Appearance> seen;
  for (int i = 0; i < count; ++i) {
    seen.push_back(given(class_names[random.below(3)], random.uniform(0.02, 0.4)));  // three of the four: all are kept
  }
  return seen;
}

LandmarkAppearance known_from(const AppearancePopulation& population, const std::vector<Appearance>& seen) {
  LandmarkAppearance known;
  for (const Appearance& one : seen) known = population.updated(known, one);
  return known;
}

/// Classes that were never reported keep a share, of 1 in 10 000 here.
constexpr double never_told = 3e-4;

TEST(MapAppearance, TheEvidenceOfAClassIsThatOfEnumeratingAllClasses) {
  const AppearancePopulation population = large_population();
  RandomStream random(1, "appearance");
  for (int t = 0; t < 200; ++t) {
    const std::vector<Appearance> before = drawn(random, 1 + static_cast<int>(random.below(5)));
    const LandmarkAppearance known = known_from(population, before);
    const Appearance next = given(class_names[random.below(class_count)], random.uniform(0.02, 0.4));
    std::vector<Appearance> all = before;
    all.push_back(next);
    const double probability = sum_of(enumerated(population, all)) / sum_of(enumerated(population, before));
    const AppearanceEvidence evidence = population.compare(known, next);
    EXPECT_NEAR(evidence.nats, std::log(probability / population.share(next.name)), never_told);
    EXPECT_GE(evidence.nats, std::log(next.class_error));
  }
}

TEST(MapAppearance, TheGateIsTheProbabilityOfBeingToldAClassAsUnlikely) {
  const AppearancePopulation population = large_population();
  RandomStream random(2, "appearance");
  for (int t = 0; t < 200; ++t) {
    const std::vector<Appearance> before = drawn(random, 2);
    const LandmarkAppearance known = known_from(population, before);
    const double error = random.uniform(0.02, 0.4);
    const Appearance next = given(class_names[random.below(3)], error);
    const std::vector<double> weights = enumerated(population, before);
    const double total = sum_of(weights);
    double own = 0.0;
    double likelier = 0.0;  // classes it is more likely to be, given correctly
    for (int k = 0; k < class_count; ++k) {
      if (ClassName(class_names[k]) == next.name) own = weights[static_cast<std::size_t>(k)];
    }
    for (int k = 0; k < 3; ++k) {
      const double weight = weights[static_cast<std::size_t>(k)];
      const bool voted = weight > own * (1.0 + 1e-9) &&
                         (before[0].name == ClassName(class_names[k]) || before[1].name == ClassName(class_names[k]));
      if (voted) likelier += weight / total;
    }
    EXPECT_NEAR(population.compare(known, next).gate, -2.0 * std::log(1.0 - (1.0 - error) * likelier), 2e-3);
  }
}

TEST(MapAppearance, TwoLandmarksLookAlikeAsMuchAsEnumerationSays) {
  const AppearancePopulation population = large_population();
  RandomStream random(3, "appearance");
  for (int t = 0; t < 200; ++t) {
    const std::vector<Appearance> one = drawn(random, 2), other = drawn(random, 3);
    const std::vector<double> w_one = enumerated(population, one), w_other = enumerated(population, other);
    double alike = 0.0;
    for (int k = 0; k < class_count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      alike += w_one[at] / sum_of(w_one) * w_other[at] / sum_of(w_other) / population.share(ClassName(class_names[k]));
    }
    const AppearanceEvidence evidence = population.compare(known_from(population, one), known_from(population, other));
    EXPECT_NEAR(evidence.nats, std::log(alike), 5.0 * never_told);
  }
}

TEST(MapAppearance, ASizeIsTheWeightedMeanOfItsMeasurements) {
  RandomStream random(4, "appearance");
  const AppearancePopulation population;
  LandmarkAppearance known;
  double information = 0.0;
  double weighted = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double sigma_m = random.uniform(0.01, 0.1);
    const double size_m = random.normal(0.5, sigma_m);
    known = population.updated(known, sized(size_m, sigma_m));
    information += 1.0 / (sigma_m * sigma_m);
    weighted += size_m / (sigma_m * sigma_m);
    EXPECT_NEAR(known.size_m, weighted / information, 1e-12);
    EXPECT_NEAR(known.size_variance_m2 * information, 1.0, 1e-12);
  }
  const AppearanceEvidence evidence = population.compare(known, sized(0.6, 0.05));
  const double off_m = 0.6 - weighted / information;
  EXPECT_NEAR(evidence.size_nis, off_m * off_m / (0.0025 + 1.0 / information), 1e-9);
  EXPECT_EQ(evidence.size_dof, 1);
  EXPECT_EQ(evidence.nats, 0.0);  // the spread of sizes is not known yet
}

/// Two-sided band on the share of right pairs beyond the 99 % quantile; false-alarm probability 1e-4 (binomial, 20 000).
TEST(MapAppearance, RightSizesAreOutsideTheirGateAsOftenAsTheyShould) {
  RandomStream random(5, "appearance");
  const AppearancePopulation population;
  constexpr int draws = 20'000;
  const double gate = chi2_quantile(0.99, 1);
  int outside = 0;
  for (int i = 0; i < draws; ++i) {
    const double true_m = random.uniform(0.2, 0.8);
    LandmarkAppearance known;
    for (int k = 0; k < 3; ++k) known = population.updated(known, sized(random.normal(true_m, 0.02), 0.02));
    outside += population.compare(known, sized(random.normal(true_m, 0.03), 0.03)).size_nis > gate ? 1 : 0;
  }
  const double sigma = std::sqrt(draws * 0.01 * 0.99);
  EXPECT_NEAR(outside, draws * 0.01, 3.9 * sigma);
}

/// Sizes of 40 objects that scatter `noise` times as much as stated; as in association, one beyond the gate of the size is not used.
double learnt_size_noise(double noise, std::uint64_t seed, int looks) {
  RandomStream random(seed, "size noise");
  MapAppearance map;
  std::vector<double> true_m;
  for (int i = 0; i < 40; ++i) true_m.push_back(random.uniform(0.2, 0.8));
  const double gate = chi2_quantile(0.999, 1);
  for (int k = 0; k < looks; ++k) {
    const auto id = static_cast<LandmarkId>(random.below(true_m.size()));
    const Appearance seen = sized(random.normal(true_m[static_cast<std::size_t>(id)], 0.02 * noise), 0.02);
    if (map.compare(id, seen).size_nis < gate) map.see(id, seen);
  }
  return map.population().size_noise();
}

/// Its estimate from 300 looks has a standard deviation of 8 %; what is cut off by the gate makes it too small by 2 %.
TEST(MapAppearance, SizesThatScatterMoreThanStatedAreFoundOut) {
  for (std::uint64_t seed = 101; seed <= 120; ++seed) {
    EXPECT_NEAR(std::log(learnt_size_noise(3.0, seed, 3000) / 9.0), 0.0, 0.4) << seed;
    EXPECT_NEAR(std::log(learnt_size_noise(2.0, seed, 3000) / 4.0), 0.0, 0.4) << seed;
  }
}

TEST(MapAppearance, SizesThatScatterAsStatedOrLessAreTakenAsStated) {
  for (std::uint64_t seed = 101; seed <= 120; ++seed) {
    for (int looks = 10; looks <= 1000; looks *= 10) {
      EXPECT_EQ(learnt_size_noise(1.0, seed, looks), 1.0) << seed;
      EXPECT_EQ(learnt_size_noise(0.5, seed, looks), 1.0) << seed;
    }
  }
}

/// Forty objects, sizes with 0.02 m of noise, of which one in `outliers` is that of any object; all are used, as where the place fits.
MapAppearance with_outliers(double outliers, std::uint64_t seed, int looks, int& far_off) {
  RandomStream random(seed, "size outliers");
  MapAppearance map;
  std::vector<double> true_m;
  for (int i = 0; i < 40; ++i) true_m.push_back(random.uniform(0.2, 0.8));
  for (int k = 0; k < looks; ++k) {
    const std::size_t i = random.below(true_m.size());
    const bool is_of_any = random.uniform(0.0, 1.0) < outliers;
    const Appearance seen = sized(is_of_any ? random.uniform(0.2, 0.8) : random.normal(true_m[i], 0.02), 0.02);
    map.count(seen);
    map.see(static_cast<LandmarkId>(i), seen);
  }
  far_off = 0;
  for (std::size_t i = 0; i < true_m.size(); ++i) {
    far_off += std::abs(map.of(static_cast<LandmarkId>(i)).size_m - true_m[i]) > 0.05 ? 1 : 0;
  }
  return map;
}

/// Some of them look like the landmark's own. The share has a standard deviation of 0.02 from 300 looks. A landmark is far off for a few
/// looks after two such sizes in a row.
TEST(MapAppearance, SizesThatSayNothingAreFoundOutAndSpoilFew) {
  int far_off = 0;
  for (std::uint64_t seed = 201; seed <= 210; ++seed) {
    int of_map = 0;
    const MapAppearance map = with_outliers(0.1, seed, 4000, of_map);
    far_off += of_map;
    EXPECT_NEAR(map.population().size_outliers(), 0.09, 0.06) << seed;
    EXPECT_EQ(map.population().size_noise(), 1.0) << seed << ": not taken for noise";
    EXPECT_LT(with_outliers(0.0, seed, 4000, of_map).population().size_outliers(), 0.01) << seed;
    EXPECT_EQ(of_map, 0) << seed;
  }
  EXPECT_LE(far_off, 12) << "of 400, as last seen, while one size in ten says nothing";
}

/// Where the place fits, a size that does not is likelier to be wrong than the match.
TEST(MapAppearance, ASizeAloneDoesNotKeepAnObservationFromItsLandmark) {
  int far_off = 0;
  const MapAppearance map = with_outliers(0.05, 211, 4000, far_off);
  const double known_m = map.of(7).size_m;
  const AppearanceEvidence near = map.compare(7, sized(known_m + 0.02, 0.02));
  const AppearanceEvidence far = map.compare(7, sized(known_m + (known_m > 0.5 ? -0.2 : 0.2), 0.02));
  EXPECT_NEAR(near.size_nis, 1.0, 0.4) << "as a Gaussian";
  EXPECT_GT(far.size_nis, near.size_nis);
  EXPECT_LT(far.size_nis, chi2_quantile(0.9999, 1)) << "a hundred of a Gaussian";
  EXPECT_GT(far.nats, std::log(0.5 * map.population().size_outliers()));
}

/// A detector that reports nonsense, of an object that has it as well: densities of the population vanish there.
TEST(MapAppearance, ASizeBeyondAllOthersIsComparedAsWell) {
  int far_off = 0;
  const MapAppearance map = with_outliers(0.05, 212, 400, far_off);
  LandmarkAppearance giant;
  giant.add_size(1e6, 1e-4);
  for (const double size_m : {1e-6, 0.5, 1e6, 1e6 + 1.0}) {
    const AppearanceEvidence evidence = map.population().compare(giant, sized(size_m, 0.02));
    EXPECT_TRUE(std::isfinite(evidence.nats)) << size_m;
    EXPECT_TRUE(std::isfinite(evidence.size_nis)) << size_m;
    EXPECT_GE(evidence.size_nis, 0.0) << size_m;
  }
  EXPECT_NEAR(map.population().compare(giant, sized(1e6 + 0.02, 0.02)).size_nis, 0.0004 / 0.0005, 1e-3);
}

TEST(MapAppearance, WhatIsNotToldSaysNothing) {
  AppearancePopulation population = large_population();
  LandmarkAppearance oak = population.updated({}, given("oak"));
  EXPECT_EQ(population.compare(oak, Appearance()).nats, 0.0);
  EXPECT_EQ(population.compare(LandmarkAppearance(), given("oak")).nats, 0.0);
  EXPECT_EQ(population.compare(oak, sized(0.5, 0.1)).size_dof, 0);
  MapAppearance map;
  map.see(3, Appearance());
  EXPECT_TRUE(map.is_empty());
  EXPECT_TRUE(map.look_alike(3, 4));
}

TEST(MapAppearance, MergedLandmarksKnowWhatBothWereTold) {
  MapAppearance map;
  for (int i = 0; i < 100; ++i) map.count(given(class_names[i % class_count]));
  for (const core::LandmarkId id : {1, 2, 9}) {
    map.see(id, given("oak"));
    map.see(id, sized(0.4, 0.02));
  }
  map.see(9, given("oak"));
  map.see(9, sized(0.4, 0.02));
  map.merge(1, 2);
  EXPECT_FALSE(map.of(2).is_given());
  EXPECT_DOUBLE_EQ(map.of(1).votes.front().nats, map.of(9).votes.front().nats);
  EXPECT_DOUBLE_EQ(map.of(1).size_variance_m2, map.of(9).size_variance_m2);
  map.remove(1);
  EXPECT_FALSE(map.of(1).is_given());
  EXPECT_TRUE(map.of(9).is_given());
}

TEST(MapAppearance, OfMoreClassesThanItHoldsTheLeastSupportedIsForgotten) {
  LandmarkAppearance known;
  known.add_vote(ClassName("oak"), 5.0);
  known.add_vote(ClassName("elm"), 3.0);
  known.add_vote(ClassName("yew"), 1.0);
  known.add_vote(ClassName("fir"), 0.5);
  EXPECT_EQ(known.votes.back().name, ClassName("yew"));
  known.add_vote(ClassName("fir"), 4.0);
  EXPECT_EQ(known.votes[1].name, ClassName("fir"));
  EXPECT_EQ(known.votes.back().name, ClassName("elm"));
}

TEST(ClassName, HoldsNoMoreThanItsBytes) {
  EXPECT_EQ(ClassName("Pseudotsuga menziesii").text(), "Pseudotsuga menziesii");
  EXPECT_TRUE(ClassName("").empty());
  EXPECT_THROW(ClassName("a name of twenty-four by"), PreconditionError);
}

}  // namespace
}  // namespace helixnav::core
