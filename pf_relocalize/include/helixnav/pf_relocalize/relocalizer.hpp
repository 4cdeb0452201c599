// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/pf_relocalize/helix_proposal.hpp"
#include "helixnav/pf_relocalize/modes.hpp"
#include "helixnav/pf_relocalize/particles.hpp"
#include "helixnav/pf_relocalize/reference_map.hpp"
#include "helixnav/pf_relocalize/scan_likelihood.hpp"

namespace helixnav::pf_relocalize {

struct RelocalizerOptions {
  SensorModel sensor;
  HelixOptions helix;
  std::size_t least_particles = 1000;  ///< floor of the adapted number
  std::size_t most_particles = 5000;   ///< ceiling, and the number at the start
  double bin_m = 0.5;                  ///< bins by which the number is adapted (kld_sample_size)
  double bin_rad = 3.0 * core::pi / 180.0;
  double kld_error = 0.05;
  double resample_below = 0.5;      ///< resample when ESS / n falls below this
  double motion_noise_scale = 1.3;  ///< factor on σ of the odometry
  ModeRadius mode_radius;
  std::size_t most_modes = 8;
  unsigned threads = 2;  ///< results do not depend on it
};

/// The state after one scan.
struct CloudState {
  core::Nanoseconds t_ns = 0;
  int scans = 0;                ///< used so far, including the first
  std::size_t particles = 0;    ///< before resampling
  double effective_size = 0.0;  ///< ESS before resampling
  bool resampled = false;
  double log_evidence = 0.0;  ///< Σ over scans of log(mean Λ): nats against "nothing here is in the map"
  core::PoseGaussian cloud;   ///< of all particles, T_base_robot
  std::vector<Mode> modes;    ///< heaviest first, at most most_modes
};

/// Resolves where the vehicle is on an old map with a particle filter (SIR) that starts on helices:
///
///   Relocalizer search(build_reference_map(joint), first_scan, options, seed);
///   search.step(odometry_since_last_scan, scan);      // …
///   search.state().modes.front();                     // heaviest hypothesis
///
/// The result is for association only. Its covariance ignores that map errors are the same in every scan, and must not
/// be fused into the map (THEORY §3.3). Poses are in the frame of the reference map; map().T_world_base converts back.
/// step() allocates nothing (scans of up to 64 observations) and costs about 0.3 µs of one core per particle with 10
/// observations. The same input and seed give the same bytes, for any number of threads.
/// Source: hybrid_masson2003 §2.1, §3.1; THEORY §3. Test: pf_relocalize/relocalizer_test.cpp.
class Relocalizer {
 public:
  /// Starts at the instant of `first_scan`, to which map.prior refers. PreconditionError for options out of range.
  Relocalizer(ReferenceMap map, const core::Scan& first_scan, const RelocalizerOptions& options, std::uint64_t seed);
  ~Relocalizer();
  Relocalizer(Relocalizer&&) noexcept;
  Relocalizer& operator=(Relocalizer&&) noexcept;

  /// Moves the cloud, weighs it with the scan (an empty one means that nothing was in view), resamples when due.
  void step(const core::Odometry& motion, const core::Scan& scan);

  const CloudState& state() const;
  const ReferenceMap& map() const;

  /// (observation, landmark) pairs that carried helices at the start; 0: nothing seen fits the prior.
  std::size_t helix_pairs() const;

  /// The cloud after the last step (after resampling): for pictures.
  const Particles& particles() const;

  /// The cloud before that resampling, with its weights: at the start, as it was drawn on helices.
  const Particles& weighted_particles() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Convergence as in the paper: standard deviations of the whole cloud below twice those of the propagation noise in x,
/// y and heading. A baseline; it accepts false closings (PROTOTYPE §0).
bool meets_paper_rule(const CloudState& state, const core::Odometry& motion);

/// The cheap gate before verification: one mode, tight, seen by a few scans, likelier than being off the map. It is not
/// evidence: on the map of another crowded place it is met more often than not.
struct GateLimits {
  double least_mass = 0.99;
  double sigma_position_m = 0.5;  ///< of x and of y
  double sigma_heading_rad = 2.0 * core::pi / 180.0;
  int least_scans = 3;
  double log_evidence = 0.0;  ///< must be exceeded
};
bool meets_gate(const CloudState& state, const GateLimits& limits = {});

/// When to give up a start: no single mode in time, or evidence that the vehicle is not on the map at all.
struct GiveUpLimits {
  int most_scans = 20;
  int null_after_scans = 8;
  double null_log_evidence = -8.0;
};
enum class SearchOutcome { searching, gate_met, timed_out, nothing_here };
SearchOutcome judge_search(const CloudState& state, const GateLimits& gate = {}, const GiveUpLimits& give_up = {});

}  // namespace helixnav::pf_relocalize
