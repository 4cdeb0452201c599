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
#include "helixnav/supervisor/name_integrity.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

class NamedDrive;

/// The Navigator's counterpart for observations that are known by name: the same identity is the same landmark, nothing is
/// ambiguous, and no search is ever needed. A sighting that contradicts its name is left out (Outcome::rejected), and a landmark
/// that its own sightings contradict is begun anew (docs/names.md). Landmarks seen as a range or a bearing only enter when their sightings fix them
/// (DelayedLandmarks).
///
/// Of a map of more than MapOptions::whole landmarks the filter holds those near the vehicle. It begins anew, from the atlas of
/// the whole drive, with a scan that sees a landmark which it does not hold, and when it has grown by half; no step costs more
/// where more is mapped. For that the drive has to be known from its begin, and every observation so far to have fixed a landmark.
/// From there on ranges and bearings of new landmarks are left out (Outcome::ambiguous). docs/adr/0015-window.md.
///
/// Frames, errors and the strong guarantee: as Navigator.
/// Test: supervisor/named/named_navigator_test.cpp, supervisor/named/named_window_test.cpp, supervisor/named/delayed_landmarks_test.cpp,
/// supervisor/guarantee_test.cpp.
class NamedNavigator {
 public:
  /// PreconditionError for a start that core::check_start refuses.
  explicit NamedNavigator(const core::PoseGaussian& start, const NavigatorOptions& options = {});

  /// Goes on in the map of an earlier session, from the pose in it and with its correlations, as if that session had not
  /// ended: `landmark_of` names its landmarks. Sightings of ranges or bearings alone that had fixed no landmark yet are lost.
  /// PreconditionError where cekf::CompressedEkf refuses the joint estimate, for a landmark that the map does not have, and for
  /// a joined map, which has no end.
  /// Test: supervisor/placing/find_place_test.cpp (equal to 1e-7).
  NamedNavigator(const core::JointMap& earlier, const std::map<std::int64_t, core::LandmarkId>& landmark_of,
                 const NavigatorOptions& options = {});

  /// Any event; `identities` belong to a scan. The report of a scan, nothing for others.
  std::optional<core::StepReport> take(const core::Event& event, const std::vector<std::int64_t>& identities);

  /// Collects motion; it reaches the filter with the next scan or fix.
  void move(const core::Odometry& odometry);

  /// One scan, with an identity for each observation; a negative one is no landmark, and of a new identity twice in one scan
  /// the first counts. PreconditionError unless there are as many identities as observations.
  core::StepReport observe(const core::Scan& scan, const std::vector<std::int64_t>& identities);

  /// As Navigator::fix.
  bool fix(const core::AbsoluteFix& fix);

  /// Pose at the last scan or fix.
  core::PoseGaussian pose() const { return filter_.pose(); }

  /// All landmarks, in order of id; costs as Navigator's.
  std::vector<core::MapLandmark> map() const;
  /// As Navigator's.
  std::vector<core::MapLandmark> sketch() const;
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const;

  /// The filter. Where it holds a part of the map, its names for landmarks are its own.
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
  /// What the filter calls the landmarks that it holds: 0, 1, … those that it began with, by increasing id, then those
  /// that it began since, one after another here as there. Of a whole map the same.
  struct FilterNames {
    std::vector<core::LandmarkId> first;  ///< ids of those that it began with, unless it holds the whole map
    core::LandmarkId next = 0;            ///< id of the first that it began since
    bool is_part = false;

    core::LandmarkId in_filter(core::LandmarkId id) const;  ///< no_landmark: not held
    core::LandmarkId in_map(core::LandmarkId name) const;
  };
  /// What came in since the last scan.
  struct Pending {
    std::optional<core::Odometry> motion;
    std::vector<core::Decision> decisions;
    core::NumericalHealth numerics = {};  ///< that no report has yet
  };
  struct NamedScan {
    core::Scan scan;
    std::vector<std::int64_t> identities;
    std::vector<core::LandmarkId> counted;  ///< as observed by it
  };
  using Taken = std::variant<core::Odometry, NamedScan, core::AbsoluteFix>;
  /// To come back to; what came in since is `taken_`.
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
  bool fitted_ = false;  ///< the lengths of the options to the sensor
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
  bool recovering_ = false;   ///< what is taken again is on the drive already

  OwnDrive drive_;
  FilterNames names_;
  int begun_with_ = 0;                          ///< landmarks, when the filter began or was to begin anew
  std::int64_t next_try_ = 0;                   ///< step before which no hand-over is tried, after one that failed
  std::optional<BeforeHandOver> before_;        ///< this call
  std::vector<Eigen::Matrix2d> remembered_m2_;  ///< covariances, by id, of landmarks when the filter left them
};

}  // namespace helixnav::supervisor
