// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "full_ekf.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::cekf {

struct Differences {
  double mean = 0.0;        ///< largest |x − x_full| over the largest |x_full|
  double covariance = 0.0;  ///< largest |P − P_full| over the largest |P_full|
};

/// Everything the filter knows against everything the oracle knows.
Differences compare(const CompressedEkf& filter, const support::FullEkf& oracle);

/// A vehicle that drives circles of 40 m through a field of landmarks, with CompressedEkf and its twin side by side:
/// predict, joint update, augment, remove (active and passive), activate, switch, in an order drawn at random.
class RandomProgram {
 public:
  struct Settings {
    Retraction retraction = Retraction::right_invariant;
    int landmarks = 220;
    int steps_per_switch = 0;  ///< 0: only when the program asks for it
    bool start_known = false;  ///< start covariance zero
  };

  RandomProgram(std::uint64_t seed, const Settings& settings);

  void step();
  void scan();
  void remove_some();
  void switch_region_randomly();
  void activate_some();
  /// Observes a mapped landmark as if it were new: a duplicate, whose id is returned.
  core::LandmarkId map_again(core::LandmarkId id);
  /// Discards the round-off between the two so far.
  void start_oracle_from_filter();

  CompressedEkf filter;
  support::FullEkf oracle;
  int switches = 0;
  int lazy_activations = 0;
  int removed = 0;

 private:
  core::Observation observe(const Eigen::Vector2d& point_m, bool cartesian);

  core::RandomStream random_;
  Settings settings_;
  core::Pose2 truth_;
  core::Pose2 T_robot_sensor_{1.2, 0.3, 0.1};
  std::vector<Eigen::Vector2d> points_m_;
  std::vector<core::LandmarkId> ids_;  ///< by landmark of the world, no_landmark when unmapped
  int steps_ = 0;
};

}  // namespace helixnav::cekf
