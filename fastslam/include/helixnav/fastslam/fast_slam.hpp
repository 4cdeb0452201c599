// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/particle_cloud.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/fastslam/options.hpp"

namespace helixnav::fastslam {

/// Names by which a caller tells landmarks apart (Association::known).
using KnownName = std::int64_t;
inline constexpr KnownName no_name = -1;  ///< an observation to leave out

/// Bytes that maps occupy.
struct MemoryReport {
  std::size_t nodes = 0;       ///< of the particles' maps, shared ones counted once
  std::size_t most_nodes = 0;  ///< the largest value of `nodes` so far
  std::size_t lineages = 0;    ///< of the grid over lineages
  std::size_t reserved = 0;    ///< of nodes, including those that are free
  std::size_t landmarks = 0;   ///< lineages that some particle may hold
};

/// FastSLAM: particles over the path, each with its own small EKF for every landmark it knows (Rao–Blackwell).
///
///   FastSlam slam(start, options, seed);
///   slam.predict(odometry);                            // as often as it comes
///   core::StepReport report = slam.update(scan);       // or update_known(scan, names)
///   slam.map(), slam.pose()
///
/// FastSLAM 1.0 and 2.0 are one algorithm with two proposals: a particle's pose before the scan is (x̂, P), with P = 0
/// and x̂ drawn for 1.0, and x̂ = f(x, u), P = J Q Jᵀ for 2.0. Matches update (x̂, P) and the weight one after the other,
/// then the pose is drawn from N(x̂, P), and each landmark is updated at the pose drawn. Weight of a scan:
///
///   Σ_matched ln[P_D/(1−P_D) N(ν; 0, S)] + Σ_unmatched ln λ + n_in_view ln(1−P_D)
///
/// Frames: world is that of the start; covariances in (x, y, heading) [m, m, rad]. Observations with two rows only
/// (range_bearing, cartesian). One filter may carry several robots that share the map: a particle then has a pose for
/// each, and predict and update state whose turn it is.
/// The pose's mean and covariance are those of the weighted cloud. They are for display: the covariance forgets what
/// resampling lost and must not be fused with another estimate (docs/fastslam.md has figures).
/// Errors: PreconditionError for arguments, NumericalError when no particle can explain a scan; everything is then as it
/// was before the call. The same input and seed give the same bytes for any number of threads.
/// Cost of a scan with m observations: about 0.4 µs · particles · m on one core, whatever the size of the map.
/// Source: fastslam_nieto2003, eq (6)–(10); Montemerlo et al. 2003 for 2.0. Tests: fastslam/*_test.cpp.
class FastSlam {
 public:
  FastSlam(const core::PoseGaussian& start, const Options& options, std::uint64_t seed);
  FastSlam(const std::vector<core::PoseGaussian>& starts, const Options& options, std::uint64_t seed);
  ~FastSlam();
  FastSlam(FastSlam&&) noexcept;
  FastSlam& operator=(FastSlam&&) noexcept;

  /// Gives every particle these landmarks, mature, with ids 0, 1, …: a map from elsewhere to begin with. PreconditionError
  /// after the first scan, and for covariances that are not positive definite.
  void begin_with(const std::vector<core::PointGaussian>& landmarks);

  /// Collects motion of a robot; it reaches the particles with that robot's next scan (exact, see core::chain).
  void predict(const core::Odometry& odometry, std::size_t robot = 0);

  /// One scan, association unknown: PreconditionError with Association::known.
  core::StepReport update(const core::Scan& scan, std::size_t robot = 0);

  /// One scan whose landmarks are known: one name per observation. A name not seen before begins a landmark.
  core::StepReport update_known(const core::Scan& scan, const std::vector<KnownName>& names, std::size_t robot = 0);

  /// T_world_robot with the motion since the robot's last scan.
  core::PoseGaussian pose(std::size_t robot = 0) const;

  /// Poses of all particles, weight by weight with weights(), as of the robot's last scan.
  const std::vector<core::Pose2>& poses(std::size_t robot = 0) const;
  std::vector<double> weights() const;

  /// Landmarks of the heaviest particle, by id. Ids are those of StepReport, never used again.
  std::vector<core::MapLandmark> map() const;

  /// Landmarks of one particle, by id.
  std::vector<core::MapLandmark> map_of(std::size_t particle) const;

  /// Index of the heaviest particle: after resampling, one that descends from it.
  std::size_t best() const;

  /// Landmarks of all particles by id, each the mixture of what the particles that hold it know, weight by weight. Ids are
  /// given where an observation begins a landmark, to all particles for which it does. Cost: particles · landmarks.
  std::vector<core::MixedLandmark> mixture() const;

  const core::CloudReport& cloud() const;

  /// [particle] index of the one it descends from, among the particles before the last scan.
  const std::vector<std::uint32_t>& parents() const;

  MemoryReport memory() const;

  /// Name of a landmark with Association::known; no_name for one that has none.
  KnownName name_of(core::LandmarkId id) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace helixnav::fastslam
