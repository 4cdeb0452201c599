// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "association/gated_scan.hpp"
#include "closing/closing.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/supervisor/factored_map.hpp"
#include "helixnav/supervisor/find_slip.hpp"
#include "helixnav/supervisor/navigator_options.hpp"
#include "loop/belief.hpp"
#include "loop/judge_fix.hpp"
#include "loop/mode.hpp"
#include "loop/tape.hpp"
#include "noise/noise_learner.hpp"
#include "placing/gap_in_sightings.hpp"
#include "placing/join_maps.hpp"
#include "placing/maps_apart.hpp"
#include "placing/scan_rhythm.hpp"
#include "placing/session_question.hpp"
#include "placing/still_there.hpp"
#include "search/whole_map_questions.hpp"
#include "smoothing/smooth_drive.hpp"
#include "systematic/odd_closing.hpp"

namespace helixnav::supervisor {

struct ClosingView;

/// The loop of the Navigator: a belief, the tape of what came in and what became of it, and the mode.
/// Where things are decided: a trigger in search/trigger.cpp, the death of a landmark in update_existence() by
/// association::LandmarkLife, a closing in closing/close_map.cpp. Scans are here, searches in
/// search/search_mode.cpp, rollback in integrity/roll_back.cpp, the strong guarantee in loop/recover.cpp.
class NavigationLoop {
 public:
  NavigationLoop(const core::PoseGaussian& start, const NavigatorOptions& options);
  NavigationLoop(const core::JointMap& earlier, const NavigatorOptions& options);  // placing/go_on.cpp

  void move(const core::Odometry& odometry);
  core::StepReport observe(const core::Scan& scan);
  bool fix(const core::AbsoluteFix& fix);
  void look_for_place_in(const core::JointMap& earlier);  // placing/find_place.cpp
  void lose(const core::Lost& lost);                      // placing/carried.cpp
  const MapsApart& maps_apart() const { return apart_; }

  const Belief& belief() const { return belief_; }
  core::PoseGaussian pose() const;  // slip/search_if_vanished.cpp

  // window/whole_estimate.cpp
  std::vector<core::LandmarkId> landmarks() const;
  bool is_placed(core::LandmarkId id) const;
  std::vector<core::PointGaussian> sketched(const std::vector<core::LandmarkId>& ids) const;
  std::vector<core::PointGaussian> marginals() const;
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const;
  std::optional<core::JointMap> factored(const std::vector<core::MapLandmark>& landmarks,
                                         FactoredMap how = FactoredMap::whole,
                                         double until_m = std::numeric_limits<double>::infinity()) const;

 private:
  /// What came in since the last scan.
  struct Pending {
    std::optional<core::Odometry> motion;
    double driven_m = 0.0;  ///< length along the road
    TimeMoved time;         ///< that it covers
    std::vector<core::Decision> decisions;
    core::NumericalHealth numerics = {};                     ///< not yet in any report
    std::vector<association::UnusedSighting> doubtful = {};  ///< matches of this scan that are left unused
    bool seeks_part = false;  ///< nothing ties the vehicle to the map, of which the filter holds a part
    std::vector<pf_relocalize::ConstellationPair> forbidden =
        {};  ///< of a place that the whole map has, at which it could not be closed in this step
    OddClosing odd_closing = {};
  };
  /// What a call has replaced so far, for recover().
  struct Undo {
    Pending pending;
    Tape::Position tape_end;
    std::uint64_t searches;
    std::optional<Mode> mode;
    std::optional<Trusted> trusted;                       ///< in that mode
    std::optional<cekf::CompressedEkf> filter;            ///< before the drive was solved
    std::optional<Tape> tape;                             ///< before odometry on it was found wrong
    std::optional<std::vector<Tape::Entry>> rolled_back;  ///< taken off the tape
    std::optional<std::pair<std::shared_ptr<const DriveMap>, Window>> drive = {};
  };

  /// Everything that a part of the drive has of its own.
  struct Part {
    core::PoseGaussian start;
    Belief belief;
    Tape tape;
    Mode mode;
    Pending pending;
    WholeMapQuestions questions;
    MapsApart apart;
    NoiseLearner noise;
  };

  // loop/navigation_loop.cpp
  core::StepReport observe_anywhere(const core::Scan& scan);
  core::StepReport observe_here(const core::Scan& scan);
  void fit_to(const core::FieldOfView& view);
  core::StepReport take_step(const core::Scan& scan, const core::Decision* note);
  core::StepReport take_as_assumed(const core::Scan& scan);
  core::StepReport step(const core::Scan& scan);
  void predict();
  bool use_fix(const WidenedFix& fix);
  GatedScan gate(const core::Scan& scan) const;
  std::vector<core::AssociationReport> associate_gated(const GatedScan& gated, const core::Scan& scan);
  void report_unfinished(const GatedScan& gated, core::StepReport& report) const;
  void update(const core::Scan& scan, bool slipped, core::StepReport& report);
  void augment(const core::Scan& scan, core::StepReport& report);
  std::vector<core::LandmarkId> update_existence(const core::Scan& scan, const core::StepReport& report);
  void drop_movers(const std::vector<Mover>& movers, core::StepReport& report, std::vector<core::LandmarkId>& died);
  core::StepReport finish(const core::Scan& scan, core::StepReport report);
  void report_late(core::StepReport& report);
  void trust(Checkpoint checkpoint);
  void checkpoint_if_settled();
  bool is_monitored() const;

  // loop/observe_thinned.cpp
  core::StepReport observe_thinned(const core::Scan& scan);
  void name_revised(core::StepReport& report) const;

  // slip/slip_in_scan.cpp
  struct SeenAfterSlip {
    double expected = 0.0, seen = 0.0;
    double by_chance = 0.0;  ///< probability that one is matched elsewhere
  };
  SeenAfterSlip seen_after(const Slip& slip, const core::Scan& scan, const Confirmation& before);
  bool is_rather_elsewhere(const Slip& slip, const core::Scan& scan, const Confirmation& before);
  bool allow_for_slip(const core::Scan& scan, const Confirmation& before, core::StepReport& report);
  std::optional<Slip> find_slip(const core::Scan& scan, const std::vector<core::AssociationReport>& fate) const;
  std::vector<SlipLandmark> landmarks_near(const core::Scan& scan) const;
  void move_unmeasured(const Eigen::Matrix3d& covariance, core::Nanoseconds t_ns);

  // slip/search_if_vanished.cpp
  void note_seen_again(const core::Scan& scan, bool slipped, const core::StepReport& report);
  bool has_slipped_away() const;
  void forget_if_tied_again();
  void leave_search();
  void drop_untied();
  core::StepReport search_since_slip(core::StepReport report);

  // moving/watch_moving.cpp
  std::vector<SeenPoint> points_to_watch(const core::Scan& scan) const;
  std::vector<Mover> watch_moving(const core::Scan& scan, const std::vector<SeenPoint>& seen, core::StepReport& report);

  // noise/learn_noise.cpp
  void learn_noise(const core::Scan& scan);
  void learn_noise(const core::AbsoluteFix& fix, const FixInnovation& innovation);
  void solve_with_learnt_noise(core::StepReport& report);
  bool solve_again(Tape again, core::StepReport& report);

  // systematic/learn_systematic.cpp
  void learn_systematic(core::StepReport& report);
  void learn_from_closing(core::StepReport& report);
  Tape as_measured() const;
  bool solve_without(const SystematicErrors& errors, core::StepReport& report);
  void merge_what_straightened(core::StepReport& report);
  void take_out_systematic(core::StepReport& report);
  void report_systematic(double nats, core::StepReport& report) const;

  // search/search_mode.cpp
  void begin_search(const core::Scan& scan);
  void search(const core::Scan& scan, core::StepReport& report);
  void close(const core::Scan& scan, const std::vector<pf_relocalize::ConstellationPair>& pairs,
             core::StepReport& report);
  void close_by_shape(const core::Scan& scan, core::StepReport& report);
  bool close_as_measured(const core::Scan& scan, const std::vector<pf_relocalize::ConstellationPair>& pairs,
                         core::StepReport& report);
  double tied_if_slipping_m() const;
  void accept(const Closing& closing, const ClosingView& view, core::StepReport& report);
  void report_closing(const Closing& closing, std::size_t pairs, double driven_m, const core::Pose2& before,
                      core::StepReport& report) const;
  void end_search(const Closing* closing);
  void merge_left_open(const core::FieldOfView& view, double tied_since_m,
                       core::StepReport& report);  // merge_left_open.cpp
  void merge_mapped_twice(core::StepReport& report);
  void note_merged(const Closing& closing, core::StepReport& report);

  // smoothing/solve_drive.cpp
  void solve_drive(core::StepReport& report);
  void report_unsolved(core::StepReport& report) const;
  Smoothing solve_on_atlas(core::NumericalHealth& numerics);

  void go_on_behind(const core::JointMap& earlier);  // placing/go_on.cpp

  // window/hand_over.cpp
  bool is_drive_known() const;
  bool may_have_window() const;
  bool needs_window() const;
  WindowNeeds window_to_map() const;
  WindowNeeds window_about(const cekf::CompressedEkf& filter) const;
  int would_hold(const WindowNeeds& needs) const;
  bool is_hand_over_due() const;
  bool is_at_edge() const;
  WindowNeeds window_to_search() const;
  std::shared_ptr<DriveMap> drive_until_now() const;
  std::shared_ptr<DriveMap> begun_drive() const;
  std::pair<cekf::CompressedEkf, Window> begun_window(const DriveMap& drive, const Belief& belief,
                                                      const WindowNeeds& needs) const;
  void begin_window(std::shared_ptr<DriveMap> drive, const WindowNeeds& needs);
  bool is_drive_due() const;
  void take_drive_if_due();
  bool hand_over(const WindowNeeds& needs);
  void hand_over_if_due();
  void widen_for_search();
  void become(std::shared_ptr<const DriveMap> drive, const Window& window);

  // search/whole_map.cpp
  bool asks_whole_map() const;
  AskedWholeMap ask_whole_map(const core::Scan& scan, core::StepReport& report);
  void ask_whether_new(const core::Scan& scan, core::StepReport& report);
  void ask_meanwhile(const core::Scan& scan, core::StepReport& report);
  LandmarksAbout branch_about() const;
  LandmarksAbout untied_about() const;
  AskedWholeMap ask_about_place(const core::Scan& scan);
  AskedWholeMap ask(LandmarksAbout& about, const Search& search, const core::Scan& scan);
  const relocalize::MapIndex& follow_old_ground(const Search& search);
  bool begin_drive_anew(const Tape& tape, const cekf::CompressedEkf& filter);
  bool close_at(const std::vector<pf_relocalize::ConstellationPair>& pairs, const Search& search,
                const Checkpoint& trigger, const core::Scan& scan, core::WholeMapDecision& decision,
                core::StepReport& report);

  // integrity/roll_back.cpp
  bool has_lost_its_place() const;
  core::StepReport roll_back_and_relocalise(const core::Scan& scan, core::StepReport report);
  core::StepReport process_in_search(const std::vector<Tape::Entry>& since, core::StepReport report);

  // placing/find_place.cpp
  relocalize::IndexOptions index_lengths() const;
  void index_maps_apart(core::StepReport& report);
  void find_place(const core::FieldOfView& view, core::StepReport& report);
  bool can_be_joined(const MapApart& apart) const;
  void note_too_few(std::size_t landmarks, core::StepReport& report);
  bool join(const MapApart& apart, const relocalize::Place& place, core::PlacedDecision& decision,
            core::StepReport& report);
  core::JointGaussian landmarks_about_session(const EarlierMap& earlier, const relocalize::Place& place) const;
  std::shared_ptr<const DriveMap> drive_by_its_end() const;
  Tape tape_behind() const;
  std::shared_ptr<DriveMap> drive_behind(const EarlierMap& earlier, const core::Pose2& T_map_session,
                                         const Closing& closing) const;
  JoinedMaps joined_at(const relocalize::Place& place, const PlaceSearch& search) const;
  Belief belief_on_both(const EarlierMap& earlier, JoinedMaps joined, const core::Pose2& T_map_session) const;
  void become_one(const MapApart& apart, Belief both, Tape tape, const Closing& closing,
                  const core::PlacedDecision& decision, core::StepReport& report);
  void begin_behind(std::shared_ptr<DriveMap> drive, Belief& belief, Tape& tape) const;

  // placing/carried.cpp
  core::JointMap map_to_keep(core::CarriedDecision& decision, double until_m) const;
  std::optional<core::JointMap> factors_to_keep(core::CarriedDecision& decision, std::size_t begun, double until_m,
                                                const std::vector<core::MapLandmark>& kept) const;
  core::LandmarkId next_name() const;
  core::JointMap unsolved_factors(const std::vector<core::MapLandmark>& landmarks,
                                  double until_m) const;  // window/whole_estimate.cpp
  Tape tape_until(double until_m) const;                  // window/whole_estimate.cpp
  Belief belief_elsewhere(const core::Pose2& T_part_robot) const;
  Part part_elsewhere(const core::CarriedDecision& decision) const;
  Part part_since(const UnsurePause& pause, core::CarriedDecision decision) const;
  Part part_apart(core::CarriedDecision decision, core::JointMap map, Belief belief) const;
  void exchange(Part& other) noexcept;
  std::optional<UnsurePause> pause_to_weigh(const core::Scan& scan) const;
  StillThere weigh_pause(const core::Scan& scan, double paused_m) const;
  core::StepReport observe_elsewhere(const core::Scan& scan, const StillThere& there, const UnsurePause& pause);
  core::StepReport begin_part_with(const core::Scan& scan, const core::CarriedDecision& decision);
  core::StepReport observe_in(Part other, const core::Scan& scan);
  core::CarriedDecision broken_off() const;
  core::CarriedDecision without_odometry() const;
  core::StepReport observe_somewhere(const core::Scan& scan);

  // placing/part_at_pause.cpp
  void forget_pauses(const core::StepReport& report);
  std::optional<UnsurePause> pause_before(const std::vector<pf_relocalize::ConstellationPair>& pairs) const;
  std::optional<SightingGap> gap_before(const std::vector<pf_relocalize::ConstellationPair>& pairs) const;
  std::int64_t step_after(double path_m) const;
  Belief belief_since(double path_m) const;
  bool part_at_pause(const std::vector<pf_relocalize::ConstellationPair>& pairs, const core::Scan& scan,
                     core::StepReport& report);
  bool part_at_gap(const std::vector<pf_relocalize::ConstellationPair>& pairs, const core::Scan& scan,
                   core::StepReport& report);
  bool part_since_untied(const core::Scan& scan, core::StepReport& report);
  bool part_between(double map_until_m, const UnsurePause& pause, const core::Scan& scan, core::StepReport& report);

  // placing/place_again.cpp
  void look_elsewhere(const core::Scan& scan, core::StepReport& report);
  void forget_old_placing() noexcept;
  const PlaceSearch* search_of_placing() const;
  bool may_be_placed_wrongly(const std::vector<pf_relocalize::ConstellationPair>& pairs) const;
  Part part_before_placing() const;
  std::vector<core::LandmarkId> gone_since_placing() const;
  void drive_again(const std::vector<Tape::Entry>& since, core::StepReport& report);
  void place_again(const core::Scan& scan, core::StepReport& report);

  // loop/process_again.hpp
  template <class AfterFix, class AfterScan>
  void process_again(const std::vector<Tape::Entry>& since, const AfterFix& after_fix, const AfterScan& after_scan);

  // loop/recover.cpp
  template <class Call>
  auto all_or_nothing(const Call& call);
  Tape::Position oldest_needed() const;
  void commit();
  void thin_coverage();
  void recover();
  Search search_from(const association::LandmarkLife& existence, std::vector<core::LandmarkId> old) const;

  const Checkpoint& checkpoint() const;
  Searching* searching() { return std::get_if<Searching>(&mode_); }
  const Searching* searching() const { return std::get_if<Searching>(&mode_); }
  /// Landmarks that an open search leaves out, ascending; none without one.
  const std::vector<core::LandmarkId>& excluded() const;

  NavigatorOptions options_;
  core::FieldOfView view_;  ///< of the first scan that states one
  core::PoseGaussian start_;
  Belief belief_;
  Tape tape_;
  NoiseLearner noise_;
  NoiseLearner noise_before_;  ///< this call, for recover(); kept so that its memory is reused
  Mode mode_;
  Pending pending_;
  OdometryRhythm odometry_rhythm_;
  Undo undo_;
  ScanRhythm rhythm_;
  std::optional<UnsurePause> pause_;  ///< that no scan has decided yet
  std::vector<UnsurePause>
      pauses_;  ///< since the place was last certain, for which no scan established that it was the same
  std::uint64_t searches_ = 0;
  WholeMapQuestions questions_;
  WholeMapQuestions questions_before_;  ///< this call, for recover()
  MapsApart apart_;                     ///< maps in which a place is sought
  std::map<std::int64_t, std::vector<std::size_t>>
      used_;  ///< [step] observations used of scans thinned since the checkpoint
};

}  // namespace helixnav::supervisor
