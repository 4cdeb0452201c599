// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "helixnav/core/appearance.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::core {

/// What class and size say about a pair of an observation and a landmark, or of two landmarks.
struct AppearanceEvidence {
  double nats = 0.0;  ///< ln p(appearance | the same object) − ln p(appearance | any object)
  double gate = 0.0;  ///< −2 ln of the probability that the same object is given a class this unlikely: adds to a NIS
  double size_nis = 0.0;  ///< squared distance of the sizes, bounded for one observation, …
  int size_dof = 0;       ///< … and 1 where both are known
};

/// How often which class and size is given: what an object of no known landmark looks like, and therefore what it means
/// that two look alike. A class k is given with p(c | k) = (1 − ε) 1[c = k] + ε q_c, q the shares of the population and
/// ε the observation's class_error, so that ln p(c | landmark) − ln q_c is bounded below by ln ε. Sizes are Gaussian about the landmark's
/// but for a learnt share, which say nothing: they are as those of any object (a detector fits a circle to a branch). What is known of a
/// landmark's size after an observation is the Gaussian with the moments of what it may be.
/// Test: core/map_appearance_test.cpp (enumeration of all classes, batch of all sizes).
class AppearancePopulation {
 public:
  void count(const Appearance& seen);
  /// A size of a known landmark, measured once more: teaches by how much sizes scatter more than they state. Rises at once, in force
  /// once it is sure (three standard deviations) and a factor of 1.35 on the variance; never below 1.
  void learn_size_noise(const LandmarkAppearance& known, const Appearance& seen);
  double size_noise() const;     ///< factor on the stated variance of a size
  double size_outliers() const;  ///< share of sizes that say nothing

  /// Share of a class among those given, in (0, 1); above 0 for one that was never given.
  double share(const ClassName& name) const;

  /// `known`, after one more observation.
  LandmarkAppearance updated(const LandmarkAppearance& known, const Appearance& seen) const;

  /// Zeros where either says nothing. O(log classes).
  AppearanceEvidence compare(const LandmarkAppearance& known, const Appearance& seen) const;
  AppearanceEvidence compare(const LandmarkAppearance& one, const LandmarkAppearance& other) const;

  /// Whether neither class nor size contradicts the two being one, each with 99.9 % if they are.
  bool look_alike(const LandmarkAppearance& one, const LandmarkAppearance& other) const;

 private:
  double probability(const LandmarkAppearance& known, const ClassName& name) const;
  double likelier(const LandmarkAppearance& known, const ClassName& than) const;
  double ln_alike(const LandmarkAppearance& one, const LandmarkAppearance& other) const;
  AppearanceEvidence compare_sizes(const LandmarkAppearance& known, double size_m, double variance_m2,
                                   double outliers) const;
  double says_nothing(const LandmarkAppearance& known, const Appearance& seen) const;
  double size_variance_m2(const Appearance& seen) const;
  double ln_density(double size_m, double variance_m2) const;

  static constexpr std::size_t enough_sizes = 8;
  static constexpr std::size_t most_classes = 256;  ///< those beyond share the remainder

  std::vector<std::pair<ClassName, std::size_t>> classes_;  ///< ascending by name
  std::size_t given_ = 0;
  std::size_t sizes_ = 0;
  double size_mean_m_ = 0.0;
  double size_squares_m2_ = 0.0;  ///< Σ of squared distances from the mean
  double size_noise_ = 1.0;       ///< estimated; in force if sure
  double size_looks_ = 20.0;      ///< that it was estimated from; at first the belief that sizes are as stated
  double outliers_ = 0.02;        ///< share of sizes, estimated
  double outlier_looks_ = 50.0;   ///< likewise
};

/// Class and size of the landmarks of a map, and the population that they come from. Nothing is stored for landmarks
/// for which neither was given. Test: core/map_appearance_test.cpp.
class MapAppearance {
 public:
  bool is_empty() const { return landmarks_.empty(); }
  const AppearancePopulation& population() const { return population_; }

  /// One observation of no landmark in particular, or of one of the map. O(log classes).
  void count(const Appearance& seen) { population_.count(seen); }
  /// The landmark was observed to look like this. O(log landmarks), and an insertion the first time.
  void see(LandmarkId id, const Appearance& seen);
  /// A landmark of an earlier drive; counts once in the population.
  void adopt(LandmarkId id, const LandmarkAppearance& known);
  void merge(LandmarkId kept, LandmarkId removed);
  void remove(LandmarkId id);

  /// Nothing given where it is unknown.
  LandmarkAppearance of(LandmarkId id) const;

  /// Zeros where either says nothing. O(log landmarks).
  AppearanceEvidence compare(LandmarkId id, const Appearance& seen) const;
  bool look_alike(LandmarkId one, LandmarkId other) const;

 private:
  using Entry = std::pair<LandmarkId, LandmarkAppearance>;
  const LandmarkAppearance* find(LandmarkId id) const;
  LandmarkAppearance& entry(LandmarkId id);

  AppearancePopulation population_;
  std::vector<Entry> landmarks_;  ///< ascending by id
};

}  // namespace helixnav::core
