// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/delayed_landmarks.hpp"
#include "helixnav/supervisor/factored_map.hpp"
#include "helixnav/supervisor/name_integrity.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

class NamedDrive;

/// The counterpart of Navigator for observations known by name: the same identity is the same landmark, nothing is
/// ambiguous, and a search is never needed. A sighting that contradicts its name is left out (Outcome::rejected), and a
/// landmark contradicted by its own sightings is created anew (docs/names.md). Landmarks seen only as a range or a
/// bearing enter once their sightings determine them (DelayedLandmarks).
///
/// If the map has more than MapOptions::whole landmarks, the filter holds those near the vehicle. It is rebuilt from
/// the atlas of the whole drive by a scan that sees a landmark it does not hold, and when it has grown by half; a step
/// does not cost more when more is mapped. This requires that the drive is known from its start and that every
/// observation so far has fixed a landmark. From there on, ranges and bearings of new landmarks are left out
/// (Outcome::ambiguous). docs/adr/0015-window.md.
///
/// Frames, errors and the strong guarantee: as Navigator.
/// Test: supervisor/named/named_navigator_test.cpp, supervisor/named/named_window_test.cpp,
/// supervisor/named/delayed_landmarks_test.cpp, supervisor/guarantee_test.cpp.
class NamedNavigator {
 public:
  /// PreconditionError for a start that core::check_start rejects.
  explicit NamedNavigator(const core::PoseGaussian& start, const NavigatorOptions& options = {});

  /// Continues in the map of an earlier session, from the pose in it and with its correlations, as if that session had
  /// not ended: `landmark_of` names its landmarks. Range-only and bearing-only sightings that had not yet fixed a
  /// landmark are lost. PreconditionError if cekf::CompressedEkf rejects the joint estimate, for a landmark that the
  /// map does not have, and for a joined map, which has no end pose.
  /// Test: supervisor/placing/find_place_test.cpp (equal to 1e-7).
  NamedNavigator(const core::JointMap& earlier, const std::map<std::int64_t, core::LandmarkId>& landmark_of,
                 const NavigatorOptions& options = {});

  /// Any event; `identities` belong to a scan. Returns the report for a scan, nothing for others.
  std::optional<core::StepReport> take(const core::Event& event, const std::vector<std::int64_t>& identities);

  /// Accumulates motion; it is applied to the filter with the next scan or fix.
  void move(const core::Odometry& odometry);

  /// One scan, with an identity for each observation; a negative identity means that it is not a landmark, and if a new
  /// identity occurs twice in one scan, the first counts. PreconditionError unless there are as many identities as
  /// observations.
  core::StepReport observe(const core::Scan& scan, const std::vector<std::int64_t>& identities);

  /// As Navigator::fix.
  bool fix(const core::AbsoluteFix& fix);

  /// Pose at the last scan or fix.
  core::PoseGaussian pose() const { return filter_.pose(); }

  /// All landmarks, in order of id; cost as for Navigator.
  std::vector<core::MapLandmark> map() const;
  /// As for Navigator.
  std::vector<core::MapLandmark> sketch() const;
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const;
  /// The map as factors, if the filter holds only a part of it; else nothing. For Navigator: a session by name continues in
  /// a joint covariance.
  std::optional<core::JointMap> factored_map(FactoredMap how = FactoredMap::whole) const;

  /// The filter. While it holds only part of the map, it uses its own names for landmarks.
  const cekf::CompressedEkf& filter() const { return filter_; }

 private:
  /// The drive, copied with the navigator.
  class OwnDrive {
   public:
    explicit OwnDrive(NamedDrive drive);
    OwnDrive(const OwnDrive& other);
    OwnDrive(OwnDrive&& other) noexcept;
    OwnDrive& operator=(OwnDrive other) noexcept;
    ~OwnDrive();
    NamedDrive& operator*() { return *drive_; }
    NamedDrive* operator->() { return drive_.get(); }
    const NamedDrive& operator*() const { return *drive_; }
    const NamedDrive* operator->() const { return drive_.get(); }

   private:
    std::unique_ptr<NamedDrive> drive_;
  };
  /// The filter's names for the landmarks it holds: 0, 1, … for those it began with, by increasing id, then those added
  /// since, consecutive here as in the map. If it holds the whole map, names and ids are the same.
  struct FilterNames {
    std::vector<core::LandmarkId> first;  ///< ids of those it began with, unless it holds the whole map
    core::LandmarkId next = 0;            ///< id of the first one added since
    bool is_part = false;

    core::LandmarkId in_filter(core::LandmarkId id) const;  ///< no_landmark: not held
    core::LandmarkId in_map(core::LandmarkId name) const;
  };
  /// What came in since the last scan.
  struct Pending {
    std::optional<core::Odometry> motion;
    std::vector<core::Decision> decisions;
    core::NumericalHealth numerics = {};  ///< not yet in any report
  };
  struct NamedScan {
    core::Scan scan;
    std::vector<std::int64_t> identities;
    std::vector<core::LandmarkId> counted;  ///< as observed by this scan
  };
  using Taken = std::variant<core::Odometry, NamedScan, core::AbsoluteFix>;
  /// To roll back to; what has come in since is `taken_`.
  struct Checkpoint {
    cekf::Snapshot filter;
    DelayedLandmarks delayed;
    NameIntegrity integrity;
    std::int64_t step;
  };
  /// What a hand-over has replaced, for recover().
  struct BeforeHandOver {
    cekf::CompressedEkf filter;
    FilterNames names;
    OwnDrive drive;
    int begun_with;
  };

  void fit_to(const core::FieldOfView& view);
  core::StepReport observe_thinned(const core::Scan& scan, const std::vector<std::int64_t>& identities);
  core::StepReport step(const NamedScan& scan);
  bool use_fix(const core::AbsoluteFix& fix);
  void report_late(core::StepReport& report);
  void predict();
  std::vector<core::AssociationReport> associate(const NamedScan& scan) const;
  void update(const core::Scan& scan, core::StepReport& report);
  void leave_wrong_names_out(const core::Scan& scan, const std::vector<cekf::Match>& matched,
                             std::vector<core::AssociationReport>& associations);
  bool waits_anew(const core::Observation& observation, core::LandmarkId known) const;
  std::vector<cekf::Match> matches_in_filter(const core::Scan& scan,
                                             const std::vector<core::AssociationReport>& associations) const;
  void augment(const NamedScan& scan, core::StepReport& report);
  void enter_names(const NamedScan& scan, const core::StepReport& report);
  template <class Call>
  auto all_or_nothing(const Call& call);
  void enter_name(std::int64_t identity, core::LandmarkId landmark);
  void checkpoint();
  void forget_names();
  void recover(std::size_t events, Pending pending);

  // window/hand_over_by_name.cpp
  void bring_into_filter(std::vector<core::AssociationReport>& associations);
  void record(const core::Scan& scan, const core::StepReport& report);
  void record(const core::AbsoluteFix& fix);
  void go_on_with_drive();
  bool hand_over(const std::vector<core::LandmarkId>& wanted);
  void begin_window(const std::vector<core::LandmarkId>& wanted);
  void take_back_hand_over() noexcept;
  void remember_covariances();

  // window/map_by_name.cpp
  template <class PointOf>
  std::vector<core::MapLandmark> map_with(const PointOf& point_of) const;

  NavigatorOptions options_;
  bool fitted_ = false;  ///< the lengths in the options have been scaled to the sensor
  double reach_m_;
  cekf::CompressedEkf filter_;
  DelayedLandmarks delayed_;
  std::map<std::int64_t, core::LandmarkId> landmark_of_identity_;
  std::map<core::LandmarkId, int> observations_;
  NameIntegrity integrity_;
  std::int64_t step_ = 0;
  Pending pending_;
  std::optional<Checkpoint> checkpoint_;
  std::vector<Taken> taken_;  ///< since the checkpoint
  bool recovering_ = false;   ///< what is processed again is already in the drive

  OwnDrive drive_;
  FilterNames names_;
  int begun_with_ = 0;                          ///< landmarks held when the filter was, or was to be, rebuilt
  std::int64_t next_try_ = 0;                   ///< no hand-over is tried before this step, after one that failed
  std::optional<BeforeHandOver> before_;        ///< in this call
  std::vector<Eigen::Matrix2d> remembered_m2_;  ///< covariances, by id, of landmarks when they left the filter
};

}  // namespace helixnav::supervisor
