// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "helixnav/atlas/phase_factor.hpp"
#include "helixnav/atlas/phase_log.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/map_factors.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::atlas {

struct State;

struct Options {
  /// A part of the map is relinearised if that would move it by more than this (the second-order error there). 0: until
  /// nothing moves by more than 1e-8 m.
  double bend_m = 1e-3;
  /// A phase is rederived from its log when its shape has moved by more than this since the last time: over 20 m, 0.1 m
  /// bend by half a millimetre. 0 and 0: until nothing moves.
  double rederive_m = 0.1;
  double rederive_rad = 0.01;
  int max_rounds = 50;  ///< per settling, up and down the tree
  /// On ground driven again and again, condense keeps the first lap and this many of the later ones as they were
  /// driven: with 4, nothing is condensed in an ordinary drive; with 1, a lap costs half as much, and variances are 5
  /// to 32 % above those with 4 after 50 to 10 laps (docs/atlas.md).
  int laps_kept = 4;
};

/// A landmark and where it is [m, map frame].
struct Place {
  core::LandmarkId id = core::no_landmark;
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
};

/// Cost of a merge: the increase in χ² and the number of degrees of freedom it removes.
struct MergeCost {
  double chi2 = 0.0;
  int dof = 0;
};

/// Two landmarks that are the same: the name removed, the name kept.
using MergePair = std::pair<core::LandmarkId, core::LandmarkId>;

/// An exact map of a whole drive. Phases of the drive are Gaussian factors at the leaves of a binary tree; a pose
/// between phases (a *clone*: clone k is where phase k begins) or a landmark is eliminated at the lowest node that
/// holds all its factors. Every node stores its part of the map and a message, which stay valid wherever that part
/// moves as a whole; a change costs the path to the root. Source: docs/atlas.md.
///
/// A copy is a snapshot: it costs O(1), shares all nodes, and may be passed to another thread. Assigning one rolls
/// back, bit for bit.
///
/// add, fix, merge, forget and reshape change what is to be solved, settle solves it, and all queries (joint, near,
/// pose …) are answered from the last settled state. Errors: PreconditionError for unknown names and wrong shapes,
/// NumericalError for numerical failures; the atlas is left as it was.
class Atlas {
 public:
  /// `start` is clone 0 in the map frame. With zero covariance it represents the map frame itself.
  explicit Atlas(const core::PoseGaussian& start = {}, const Options& options = {});
  /// The map that factors() has put away, with the same estimates. Its phases have no logs: they turn and bend with the map, but are not
  /// derived again. One that was not solved is solved first, and stays where it is if that does not end. PreconditionError if its parts
  /// do not fit together, NumericalError if it has no solution.
  /// Test: atlas/factors_test.cpp.
  static Atlas from_factors(const core::MapFactors& map, const Options& options = {});
  Atlas(const Atlas& other);
  Atlas(Atlas&& other) noexcept;
  Atlas& operator=(const Atlas& other);
  Atlas& operator=(Atlas&& other) noexcept;
  ~Atlas();

  /// Appends a phase that begins at the last clone; the clone where it ends gets the next number. With a log it can be
  /// rederived when its shape has moved. Structure only: O(path), no numerics. NumericalError, naming the landmarks, if
  /// the phase leaves landmarks undetermined given its entry and the landmarks known before (a range-only point seen
  /// once): these must stay in the window. Returns the index of the phase. Test: atlas/settle_test.cpp (equals a full
  /// pass bit for bit).
  int add(PhaseFactor factor, std::shared_ptr<const PhaseLog> log = nullptr);

  /// An absolute position of the robot at a clone. It is a factor relative to the map frame, so that messages can still
  /// be rotated. PreconditionError for a clone whose phase was condensed.
  /// Test: atlas/joint_test.cpp.
  void fix(int clone, const core::AbsoluteFix& fix);

  /// Merges each pair into one landmark; from now on both names refer to it. Exact: the factors that hold the one are
  /// rewritten to hold the other. Test: atlas/merge_test.cpp (χ² equals the batch difference).
  void merge(const std::vector<MergePair>& pairs);

  /// What merging would add to χ², iterated to the bend that the options allow; this atlas is unchanged and must be
  /// settled.
  MergeCost merge_cost(const std::vector<MergePair>& pairs) const;

  /// The landmark stays in the estimate but loses its name.
  void forget(core::LandmarkId id);

  /// Rebuilds the layout of the whole tree by position. Worthwhile after a long drive over old ground; results stay the
  /// same up to rounding.
  void reshape();

  /// This map and that of another drive, which began somewhere on it: one map in the frame of this one, with the phases of
  /// the other behind a phase without landmarks, `gap`, from where this drive ends to where the other begins (3 rows, with
  /// an inverse; wide, if only landmarks tell). What the other knows of a frame of its own, by fixes or by its start, is
  /// left out. Both must be settled, as the result is, and the names of their landmarks differ: merge those that are the same.
  /// O(N log N). Test: atlas/factors_test.cpp.
  Atlas followed_by(const RelativeGaussian& gap, const Atlas& drive) const;

  /// Bounds the cost of ground driven again and again. A settled phase on ground that was driven again more than
  /// options.laps_kept times (three quarters of its landmarks with names are seen by others) becomes part of the earlier phase
  /// that has most of its landmarks, the oldest phase first. Its information on these landmarks is kept; lost are its
  /// ties to the phases before and after, its information on landmarks that the other phase does not have, and its fix
  /// if as many others on that ground have one. All of that is marginalised as if it belonged to variables of its own,
  /// which takes information away and never adds any: covariances are conservative. The last two phases stay, and so
  /// does a phase that alone holds a landmark with a name. The shape of a condensed phase is kept for poses_of. Call before settle,
  /// which then solves the result. Returns how many phases were condensed. Test: atlas/condense_test.cpp.
  int condense();

  /// Solves until everything bent has been relinearised and everything nearby has its new estimate. After each node it
  /// calls `should_stop`; if that returns true, settle returns false, queries are still answered from the last settled
  /// state, and the next call continues. Stopping does not change the result in any bit. Test: atlas/settle_test.cpp
  /// (stopped at every node). If this does not end, as after tens of metres of drift, it starts again with damped
  /// steps, over the whole tree and without calling `should_stop` (docs/atlas.md).
  bool settle(const std::function<bool()>& should_stop = {});
  bool is_settled() const;

  int phase_count() const;                              ///< settled ones
  bool knows(core::LandmarkId id) const;                ///< settled, and not forgotten
  double chi2() const;                                  ///< of all measurements, at the settled estimate
  core::Pose2 pose() const;                             ///< of the last clone, map frame
  core::Pose2 clone(int k) const;                       ///< O(path)
  Eigen::Vector2d landmark(core::LandmarkId id) const;  ///< O(path)

  /// Joint estimate of the last clone and the given landmarks, in the map frame and in the order given. Forward solves
  /// along their paths to the root only: P = YᵀY, Y = L⁻¹E. Test: atlas/joint_test.cpp (dense inverse, 1e-8).
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const;

  /// Landmarks within a distance of a point in the map frame, by increasing name. Descends only where there are some.
  /// Test: atlas/near_test.cpp (brute force).
  std::vector<Place> near(const Eigen::Vector2d& center_m, double radius_m) const;

  /// Places of these landmarks, in the order given. O(their paths together).
  std::vector<Place> places_of(const std::vector<core::LandmarkId>& ids) const;
  std::vector<Place> landmarks() const;     ///< all with a name, by increasing name. O(N)
  std::vector<core::Pose2> clones() const;  ///< all. O(N)

  /// Poses at every step of a phase: the shape it was last derived with, from its entry to its exit. Needs no log.
  std::vector<core::Pose2> poses_of(int phase) const;
  /// The same for all phases, [phase][step], O(N): one by one, each would pay for its path to the root.
  /// Test: atlas/joint_test.cpp.
  std::vector<std::vector<core::Pose2>> poses() const;

  /// The settled map as a value to be put away. Names of landmarks merged into others are not in it. O(N); the Gaussians
  /// are shared. PreconditionError if it has no phase.
  core::MapFactors factors() const;
  /// The same of what was added to a new atlas, without solving it, which takes most of the time and memory: the values are where `add`
  /// put them. Test: atlas/factors_test.cpp.
  core::MapFactors unsolved_factors() const;

  /// Size of the tree as it was settled, for benchmarks and reports.
  struct Size {
    int phases = 0;
    int condensed = 0;  ///< of these, condensed
    int depth = 0;
    int largest_front = 0;  ///< rows
    int root_front = 0;
    double factor_nonzeros = 0.0;   ///< of all L
    double message_nonzeros = 0.0;  ///< of all messages
  };
  Size size() const;
  int nodes_redone() const;  ///< fronts eliminated since construction or copy

 private:
  friend struct AtlasAccess;  // for tests of the internals

  std::unique_ptr<State> working_;
  std::unique_ptr<State> settled_;
  int nodes_redone_ = 0;
};

/// PreconditionError if the parts of a map that was put away do not fit together. O(its bytes).
void check_factors(const core::MapFactors& map);

}  // namespace helixnav::atlas
