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
#include "helixnav/core/se2.hpp"

namespace helixnav::atlas {

struct State;

struct Options {
  /// A part of the map is linearised again where that would move it by more than this (the second-order error of what is
  /// there). 0: until nothing moves by more than 1e-8 m.
  double bend_m = 1e-3;
  /// A phase is derived from its log again when its shape has moved by more than this since: over 20 m, 0.1 m bend by half a
  /// millimetre. 0 and 0: until nothing moves.
  double rederive_m = 0.1;
  double rederive_rad = 0.01;
  int max_rounds = 50;  ///< of one settling, up and down the tree
  /// Of ground that is driven again and again condense keeps the first lap and this many of the later ones as they were driven: with 4
  /// an ordinary drive has nothing condensed; with 1 a lap costs half as much, and variances are 5 to 32 % above those of 4 after 50 to 10 laps (docs/atlas.md).
  int laps_kept = 4;
};

/// A landmark and where it is [m, map frame].
struct Place {
  core::LandmarkId id = core::no_landmark;
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
};

/// What a merge would cost: the rise of χ² over the degrees of freedom that it takes away.
struct MergeCost {
  double chi2 = 0.0;
  int dof = 0;
};

/// Landmarks that are one: the name that goes, the name that stays.
using MergePair = std::pair<core::LandmarkId, core::LandmarkId>;

/// An exact map of a whole drive. Phases of the drive are Gaussian factors at the leaves of a binary tree; a pose between phases
/// (a *clone*: clone k is where phase k begins) and a landmark are eliminated at the lowest node that holds all their factors.
/// Every node remembers its part of the map and a message, which stay valid wherever that part is carried as a whole; a
/// change costs the path to the root. Source: docs/atlas.md.
///
/// A copy is a snapshot: it costs O(1), shares all nodes, and may go to another thread. Assigning one rolls back, bit for bit.
///
/// add, fix, merge, forget and reshape change what is to be solved, settle solves it, and everything that is asked for (joint, near, pose …)
/// comes from what was settled last. Errors: PreconditionError for unknown names and wrong shapes, NumericalError where mathematics
/// breaks; the atlas is left as it was.
class Atlas {
 public:
  /// `start` is clone 0 in the map frame. With zero covariance it stands for the map frame itself.
  explicit Atlas(const core::PoseGaussian& start = {}, const Options& options = {});
  Atlas(const Atlas& other);
  Atlas(Atlas&& other) noexcept;
  Atlas& operator=(const Atlas& other);
  Atlas& operator=(Atlas&& other) noexcept;
  ~Atlas();

  /// Appends a phase that begins at the last clone; the clone where it ends gets the next number. With a log it can be derived again
  /// when its shape has moved. Only structure: O(path) without numerics. NumericalError, naming them, when given its
  /// entry and the landmarks known before, the phase leaves landmarks undetermined (a range-only point seen once): these must stay in the
  /// window. Returns the index of the phase. Test: atlas/settle_test.cpp (equals a full pass bit for bit).
  int add(PhaseFactor factor, std::shared_ptr<const PhaseLog> log = nullptr);

  /// An absolute position of the robot at a clone. It is a factor relative to the map frame, so that messages still turn.
  /// PreconditionError for a clone whose phase was condensed.
  /// Test: atlas/joint_test.cpp.
  void fix(int clone, const core::AbsoluteFix& fix);

  /// Makes one landmark of each pair; both names mean it from now on. Exact: the factors that hold the one are rewritten to
  /// hold the other. Test: atlas/merge_test.cpp (χ² equals the batch difference).
  void merge(const std::vector<MergePair>& pairs);

  /// What merging would add to χ², iterated to the bend that options allow; this atlas stays as it is and must be settled.
  MergeCost merge_cost(const std::vector<MergePair>& pairs) const;

  /// The landmark keeps its part in the estimate and loses its name.
  void forget(core::LandmarkId id);

  /// Lays the whole tree out anew, by position. Worth it after a long drive over old ground; results stay the same to rounding.
  void reshape();

  /// Bounds what ground driven again and again costs. Of the settled phases, one on ground that was driven again more than options.laps_kept
  /// times (three quarters of its landmarks are seen by others), the oldest first, becomes part of the phase before it that has most of them. What it
  /// says of these landmarks is kept; lost are its ties to the phases before and after, what it says of landmarks that
  /// the other does not have, and its fix, where as many others on the ground have one. All of that is marginalised as if
  /// it were of variables of its own, which takes information away and never adds any: covariances are conservative. The last two phases
  /// stay, and so does what alone holds a landmark. Of a phase that was condensed its shape is kept, for poses_of. Call before settle, which then
  /// solves it. Returns how many phases were condensed. Test: atlas/condense_test.cpp.
  int condense();

  /// Solves until what is bent is linearised again and everything near has its new estimate. After each node it asks
  /// `should_stop`; when that says true it returns false, what was settled last still answers, and the next call goes on.
  /// Stopping changes no bit of the result. Test: atlas/settle_test.cpp (stopped at every node). Where that does not end, as
  /// after tens of metres of drift, it begins again with steps that are cut, over the whole tree and without asking (docs/atlas.md).
  bool settle(const std::function<bool()>& should_stop = {});
  bool is_settled() const;

  int phase_count() const;                              ///< settled ones
  bool knows(core::LandmarkId id) const;                ///< settled, and not forgotten
  double chi2() const;                                  ///< of all measurements, at the settled estimate
  core::Pose2 pose() const;                             ///< of the last clone, map frame
  core::Pose2 clone(int k) const;                       ///< O(path)
  Eigen::Vector2d landmark(core::LandmarkId id) const;  ///< O(path)

  /// Joint estimate of the last clone and the landmarks given, in the map frame and order. Forward solves along their paths to the root
  /// only: P = YᵀY, Y = L⁻¹E. Test: atlas/joint_test.cpp (dense inverse, 1e-8).
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const;

  /// Landmarks within a distance of a place in the map frame, by increasing name. Goes down only where the tree has some.
  /// Test: atlas/near_test.cpp (brute force).
  std::vector<Place> near(const Eigen::Vector2d& center_m, double radius_m) const;

  /// Of these landmarks, in their order. O(their paths together).
  std::vector<Place> places_of(const std::vector<core::LandmarkId>& ids) const;
  std::vector<Place> landmarks() const;     ///< all with a name, by increasing name. O(N)
  std::vector<core::Pose2> clones() const;  ///< all. O(N)

  /// Poses at every step of a phase: the shape it was last derived with, from its entry to its exit. Needs no log.
  std::vector<core::Pose2> poses_of(int phase) const;
  /// The same of all phases, [phase][step], O(N): one by one each would pay for its path to the root. Test: atlas/joint_test.cpp.
  std::vector<std::vector<core::Pose2>> poses() const;

  /// Size of the tree as it was settled, for benchmarks and reports.
  struct Size {
    int phases = 0;
    int condensed = 0;  ///< of them, by condense
    int depth = 0;
    int largest_front = 0;  ///< rows
    int root_front = 0;
    double factor_nonzeros = 0.0;   ///< of all L
    double message_nonzeros = 0.0;  ///< of all messages
  };
  Size size() const;
  int nodes_redone() const;  ///< since construction or copy: fronts eliminated

 private:
  friend struct AtlasAccess;  // tests of the room look inside

  std::unique_ptr<State> working_;
  std::unique_ptr<State> settled_;
  int nodes_redone_ = 0;
};

}  // namespace helixnav::atlas
