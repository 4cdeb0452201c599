// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "helixnav/cekf/active_part.hpp"
#include "helixnav/cekf/filter_options.hpp"
#include "helixnav/cekf/match.hpp"
#include "helixnav/cekf/outlook.hpp"
#include "helixnav/cekf/passive_covariance.hpp"
#include "helixnav/cekf/phase.hpp"
#include "helixnav/cekf/snapshot.hpp"
#include "helixnav/cekf/update_workspace.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::core {
class Panels;
}

namespace helixnav::cekf {

struct MovedRows;

/// Exact EKF-SLAM over a pose and point landmarks, at a cost per step that does not depend on the size of the map: only
/// the landmarks in the vehicle's neighbourhood are active; the effect of a phase's steps on all others is accumulated
/// in the weights of ActivePart and applied when the region switches.
///
/// Frames: everything is in the map frame; the pose is T_world_robot, covariances in (x, y, heading) [m, m, rad].
/// A copy shares the covariance of the passive landmarks until one of the two absorbs a phase into it: O(N·q) per phase
/// kept. Every call either succeeds or throws PreconditionError (arguments), NumericalError (S not positive definite, a
/// variance that would be negative or not finite) or std::bad_alloc and leaves the filter as it was. Costs below are
/// for n active landmarks, q weights (2·3+4·n right-invariant, 3+2·n standard, none where all landmarks are active),
/// m rows of innovation.
/// Source: THEORY §1 and §1b. Test: tests/cekf (equal to a plain full EKF on random programs, both retractions).
class CompressedEkf {
 public:
  /// Two landmarks declared to be the same: the one kept and the one removed.
  using LandmarkPair = std::pair<core::LandmarkId, core::LandmarkId>;

  /// Start covariance symmetric positive semidefinite; all zero is allowed (map frame = pose at start).
  explicit CompressedEkf(const core::PoseGaussian& start, const FilterOptions& options = {});

  /// From the joint estimate of the pose and all landmarks of the map, which keep their ids; later ones are named
  /// `next_name` and above. The region around the vehicle is active. PreconditionError for ids that are duplicate,
  /// negative or not below `next_name`, sizes that do not fit, values that are not finite or negative variances; the
  /// caller guarantees that the covariance is positive semidefinite. O(N²). Test: cekf/joint_start_test.cpp.
  CompressedEkf(const core::JointGaussian& start, core::LandmarkId next_name, const FilterOptions& options = {});

  const FilterOptions& options() const { return options_; }

  /// Moves the vehicle: F and the noise from core::compose_jacobians. O(n + q).
  void predict(const core::Odometry& odometry);

  /// Puts the vehicle elsewhere, independent of the whole map. For comparison with filters that restart; what is known
  /// about the vehicle is discarded. Covariance symmetric positive semidefinite. O(n + q). Test: cekf/closing_test.cpp.
  void replace_pose(const core::PoseGaussian& pose);

  /// Joint EKF update with all matches. Passive landmarks are activated first: nothing is discarded. O((n + q)²·m).
  UpdateResult update(const std::vector<Match>& matches);
  /// The same, unless νᵀS⁻¹ν is above `most_nis`: then returns nothing and changes nothing.
  /// Test: cekf/update_within_test.cpp.
  std::optional<UpdateResult> update_within(const std::vector<Match>& matches, double most_nis);
  /// The innovation that update would use, for a caller that weighs its matches one by one; read-only. O(m²·n).
  /// Test: cekf/update_within_test.cpp.
  Innovation innovation(const std::vector<Match>& matches) const;
  /// Update with rows that the caller has linearised; `ids` without repetition. PreconditionError for sizes that do not
  /// fit and values that are not finite. Test: cekf/equality_test.cpp, cekf/bad_input_test.cpp.
  UpdateResult update(const PointRows& rows);
  /// Joint Gauss-Newton update to the minimum of J = |x ⊖ x̂|²_P + |ν|²_R, for closings where one linearisation is not
  /// enough; the covariance is that of an update linearised at the minimum. Result: J and its degrees of freedom.
  /// NumericalError when the iteration has not converged (step below 1e-9) after max_iterations.
  UpdateResult update_iterated(const std::vector<Match>& matches, int max_iterations = 50);
  /// J of update_iterated and the share of each match in it, without updating; infinite when it does not converge.
  CostByPart iterated_cost(const std::vector<Match>& matches, int max_iterations = 50) const;

  /// νᵀS⁻¹ν of a position fix of a point on the robot, for the caller's gate.
  UpdateResult position_innovation(const core::AbsoluteFix& fix) const;
  /// Update with the fix; involves only the vehicle and so costs no more than one observation.
  UpdateResult update_position(const core::AbsoluteFix& fix);

  /// New active landmark where the observation (kind with two rows) sees it.
  core::LandmarkId augment(const core::Observation& observation, const core::Pose2& T_robot_sensor);
  /// The same with a name chosen by the caller that no landmark has yet. Names given later are above it.
  void augment(const core::Observation& observation, const core::Pose2& T_robot_sensor, core::LandmarkId name);
  /// New active landmark as a linear function of pose and landmarks, with all its correlations; the landmarks it
  /// depends on are activated first. Its mean is set by the caller, who linearised there. O((n + q)·ids).
  /// Test: cekf/equality_test.cpp, cekf/bad_input_test.cpp.
  core::LandmarkId augment(const DerivedPoint& point);

  /// Conditions on kept = removed (difference known to sigma_m) for all pairs at once, iterated like update_iterated,
  /// then removes the second of each pair. Result: J and dof = 2·pairs. sigma_m = 0 is allowed as long as S stays
  /// positive definite.
  UpdateResult merge(const std::vector<LandmarkPair>& kept_removed, double sigma_m = 0.02);
  UpdateResult merge(core::LandmarkId kept, core::LandmarkId removed, double sigma_m = 0.02) {
    return merge({{kept, removed}}, sigma_m);
  }
  /// J of merge and the share of each pair in it, without merging; infinite when the iteration does not converge.
  CostByPart merge_cost(const std::vector<LandmarkPair>& kept_removed, double sigma_m = 0.02) const;

  /// Forgets a landmark, active or passive. O(n + q).
  void remove(core::LandmarkId id);

  /// Makes a passive landmark active in mid-phase, exactly and without a global update. No effect on an active one.
  /// O(N·phases kept + q²).
  void activate(core::LandmarkId id);

  /// Switches to the region around the vehicle when it has left its cell by the hysteresis, or when the number of
  /// active landmarks is above both max_active_landmarks and twice the number seen by the last update; if the whole map
  /// is active, above 1 + w times that, with w weights per anchor. True if it switched. Test: cekf/law_test.cpp.
  bool switch_region_if_due();
  /// Switches to the region around the vehicle.
  void switch_region();
  /// Switches to exactly these active landmarks.
  void switch_region(const std::vector<core::LandmarkId>& active);
  /// Brings the passive part up to date and keeps the active set. O(N²·q).
  void global_update();

  /// Health of the updates since the last call, not of queries (iterated_cost, merge_cost, position_innovation). A
  /// restore does not change it: it is not part of the estimate. Test: cekf/numerical_health_test.cpp.
  core::NumericalHealth take_health() noexcept { return std::exchange(workspace_.health, {}); }

  core::PoseGaussian pose() const;
  /// Marginal of any landmark, read-only. O(1) active, O(q²) passive.
  core::PointGaussian landmark(core::LandmarkId id) const;
  /// The same for many: O(q²) each, at the speed of a matrix product. Test: cekf/law_test.cpp.
  std::vector<core::PointGaussian> marginals(const std::vector<core::LandmarkId>& ids) const;
  /// Mean of any landmark. O(1) active, O(q) passive.
  Eigen::Vector2d landmark_mean(core::LandmarkId id) const;
  /// Upper bound on the standard deviation in any direction (square root of the trace), for searches that must not pay
  /// for a marginal. For a passive landmark it is that of the start of the phase, which shrinks with every update of the
  /// phase; the right-invariant transport P' = N·P·Nᵀ, N = I + J·Δ·e_θᵀ, adds at most |Δ|·σ_θ where an update moves the
  /// mean by Δ (THEORY §1b): twice that for the total displacement since. O(1) active, O(q) passive.
  /// Test: cekf/law_test.cpp.
  double landmark_sigma_bound_m(core::LandmarkId id) const;
  /// Covariance of a landmark, active or passive, with the pose. O(q). Test: cekf/law_test.cpp.
  Eigen::Matrix<double, 2, 3> covariance_with_pose(core::LandmarkId id) const;
  /// landmark_mean, landmark_sigma_bound_m and covariance_with_pose of many landmarks in one pass over the basis: O(q) each,
  /// at the speed of memory. Test: cekf/law_test.cpp.
  std::vector<Outlook> outlooks(const std::vector<core::LandmarkId>& ids) const;
  /// Pose and the landmarks in the order given, active or passive, read-only.
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const;
  /// Covariance of landmarks (rows) with others (columns), two rows and columns each, active or passive, read-only: for
  /// the differences of many pairs, where a joint for each would go through the kept phases every time.
  /// O((r + c)·q·phases kept), and products of that depth. Test: cekf/law_test.cpp.
  Eigen::MatrixXd cross_covariance(const std::vector<core::LandmarkId>& rows,
                                   const std::vector<core::LandmarkId>& columns) const;

  bool contains(core::LandmarkId id) const;
  bool is_active(core::LandmarkId id) const;
  std::vector<core::LandmarkId> landmarks() const;
  const std::vector<core::LandmarkId>& active_landmarks() const { return active_.ids; }
  /// Landmarks whose mean is within radius_m of the point, in order of id. Searches only where the passive landmarks
  /// were when the phase began, widened by how far those found there have moved since: cost O(nearby landmarks · q).
  std::vector<core::LandmarkId> landmarks_within(const Eigen::Vector2d& point_m, double radius_m) const;
  int active_count() const { return static_cast<int>(active_.ids.size()); }
  int mapped_count() const { return static_cast<int>(places_.size()); }

  /// O((n + q)²) bytes, without the passive part.
  Snapshot snapshot() const;
  /// The filter as it was at the snapshot, bit for bit; covariances between two passive landmarks to round-off when a
  /// phase older than the snapshot's has been absorbed in between. PreconditionError when the snapshot's phase is out of reach.
  void restore(const Snapshot& snapshot);
  bool can_restore(const Snapshot& snapshot) const;
  /// Landmarks named from now on get ids from `id` upwards, so that after a restore, names given since the snapshot are
  /// not given to others. No effect if all ids below are taken.
  void name_from(core::LandmarkId id);
  /// Id of the next landmark.
  core::LandmarkId next_name() const { return active_.next_id; }
  /// Phases from `phase` on are kept restorable instead of being absorbed when they close; each costs 2N·(2q + 2n)
  /// doubles and slows down switches and activations. Default: only the open one.
  void keep_since(long phase);
  /// Keeps the open phase restorable in addition to those already kept; this call does not absorb anything.
  /// Test: supervisor/tape_test.cpp.
  void keep_open_phase() noexcept;
  long phase() const { return phases_.back().number; }
  /// Memory used by the closed phases that are kept.
  std::size_t kept_bytes() const;
  int phases_kept() const { return static_cast<int>(phases_.size()); }

 private:
  enum class Whereabouts : unsigned char { nowhere, active, passive };
  struct Place {
    Whereabouts where = Whereabouts::nowhere;
    int index = -1;  ///< in active_.ids, or the slot
  };
  struct NamedPlace {
    core::LandmarkId id = core::no_landmark;
    Place place;
  };

  std::vector<NamedPlace>::const_iterator from_name(core::LandmarkId id) const;
  const Place* find_place(core::LandmarkId id) const;
  void set_place(core::LandmarkId id, const Place& place);
  const Place& place_of(core::LandmarkId id, const char* verb) const;
  int weights_per_anchor() const { return options_.retraction == Retraction::right_invariant ? 2 : 1; }

  // start.cpp
  void check_options() const;
  void begin_at(const core::PoseGaussian& pose);
  void take_in_passive(const core::JointGaussian& start, Phase& first);

  // augment.cpp
  void name_newest(const Eigen::Vector2d& point_m, core::LandmarkId id);
  void derive_newest(const DerivedPoint& point);
  void check_newest(const Eigen::Vector2d& point_m, const Eigen::Matrix2d& covariance_m2) const;
  void make_room_for_newest();
  void check_derived_point(const DerivedPoint& point) const;

  // update.cpp, update_iterated.cpp, merge.cpp, apply_correction.cpp
  void check_matches(const std::vector<Match>& matches, const char* verb) const;
  void check_rows(const PointRows& rows) const;
  bool are_active(const std::vector<Match>& matches) const;
  void check_pairs(const std::vector<LandmarkPair>& kept_removed, double sigma_m, const char* verb) const;
  void gather_involved(UpdateWorkspace& w) const;
  void gather_involved_unactivated(UpdateWorkspace& w) const;
  template <class Linearise>
  UpdateResult iterate_and_apply(int max_iterations, const char* verb, const Linearise& linearise);
  void check_variances(const UpdateWorkspace& w, const char* verb) const;
  void apply_correction(UpdateWorkspace& w, const char* verb);
  void add_transport(UpdateWorkspace& w) const;
  void move_means(const UpdateWorkspace& w);

  // remove.cpp, activate.cpp, passive.cpp
  void remove_active(int index);
  struct BeforeActivations {
    int active = 0;
    Eigen::VectorXd theta;  ///< if something was passive
  };
  BeforeActivations before_activations(bool all_active) const;
  void undo_activations(BeforeActivations& before);
  void make_room_for_landmark(int weights);
  void append_columns(Phase& phase, const Eigen::Ref<const Eigen::MatrixXd>& start_columns) const;
  void append_weights_for(const std::vector<Eigen::Vector2d>& offsets_m, bool with_vehicle, ActivePart& part) const;
  template <class Vehicle>
  static void refer_to_vehicle(const Phase& phase, const std::vector<int>& slots, const Vehicle& vehicle,
                               Eigen::Ref<Eigen::MatrixXd> columns);
  void append_first_columns(Phase& phase, const std::vector<int>& slots, Eigen::Ref<Eigen::MatrixXd> anchors) const;
  void append_late_columns(Phase& phase, const std::vector<int>& slots, Eigen::MatrixXd& start_columns) const;
  Eigen::MatrixXd phase_start_columns(const std::vector<int>& slots) const {
    return start_columns(slots, phases_.size() - 1);
  }
  Eigen::MatrixXd start_columns(const std::vector<int>& slots, std::size_t phase) const;
  void fill_start_columns(const std::vector<int>& slots, std::size_t phase, const std::vector<Eigen::Index>& at,
                          Eigen::Ref<Eigen::MatrixXd> columns) const;
  Eigen::MatrixXd phase_start_blocks(const std::vector<int>& slots) const;
  Eigen::MatrixXd phase_start_blocks(const std::vector<int>& rows, const std::vector<int>& columns) const;
  Eigen::Vector2d passive_mean(int slot) const;
  std::vector<Eigen::Vector2d> moved_m(const std::vector<int>& slots) const;
  std::vector<core::PointGaussian> passive_marginals(const std::vector<int>& slots) const;
  double sigma_bound_m(int slot, double moved_m) const;
  std::vector<core::LandmarkId> passive_in_cells(const Eigen::Vector2d& point_m, double reach_m) const;
  Eigen::MatrixXd basis_rows(const std::vector<int>& slots) const;
  void fill_own_of_many(const std::vector<int>& slots, const std::vector<int>& rows, const Eigen::MatrixXd& e,
                        Eigen::MatrixXd& C) const;
  struct Parts;
  Parts parts_of(const std::vector<core::LandmarkId>& ids, const char* verb) const;

  // global_update.cpp, switch_region.cpp, snapshot.cpp
  struct BeforeSwitch;
  int assign_slots(Phase& phase);
  ReservedMatrix end_columns(int slots) const;
  std::shared_ptr<const ReservedMatrix> hand_over_covariance(int slots, BeforeSwitch& before);
  void take_back_covariance(BeforeSwitch& before);
  std::shared_ptr<const ReservedMatrix> close_phase(Phase& next, BeforeSwitch& before);
  void absorb_closed_phases(long until);
  void check_own_covariances(const Phase& next) const;
  void reopen_phase(BeforeSwitch& before);
  void open_phase(Phase&& next, const Eigen::Ref<const Eigen::MatrixXd>& columns,
                  const std::vector<core::LandmarkId>& active);
  void freeze_slots(Phase& phase, const std::vector<core::LandmarkId>& active) const;
  ActivePart room_for(const Phase& phase, const std::vector<core::LandmarkId>& active,
                      const std::vector<int>& slots) const;
  void start_covariance(const ReservedMatrix& anchors, ActivePart& part) const;
  void start_whole_covariance(const std::vector<MovedRows>& moves, Eigen::VectorXd& column, ReservedMatrix& anchors,
                              ActivePart& part) const;
  std::vector<core::LandmarkId> region_around_vehicle() const;
  int most_active() const;
  int most_when_whole() const;
  bool is_whole() const;
  bool is_whole_cheaper() const;
  bool is_region_due() const;
  Eigen::Vector2i cell_of(const Eigen::Vector2d& point_m) const;
  void return_slots(Phase& phase);
  static void open_again(Phase& phase);
  void rebuild_places();

  FilterOptions options_;
  ActivePart active_;
  std::vector<Phase> phases_;  ///< closed ones that are kept, then the open one
  std::shared_ptr<PassiveCovariance> absorbed_ =
      std::make_shared<PassiveCovariance>();  ///< shared by copies until one writes
  std::vector<int> free_slots_;
  std::vector<NamedPlace> places_;  ///< of all existing landmarks, ascending by id
  long last_phase_ = 0;             ///< numbers are never used twice, not even after a restore
  long keep_since_;
  UpdateWorkspace workspace_;
};

}  // namespace helixnav::cekf
