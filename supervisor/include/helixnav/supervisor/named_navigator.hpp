// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <variant>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/delayed_landmarks.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

/// The Navigator's counterpart for observations that are known by name: the same identity is the same landmark, nothing is
/// ambiguous, and no search is ever needed. Landmarks seen as a range or a bearing only enter when their sightings fix them
/// (DelayedLandmarks).
/// Frames, errors and the strong guarantee: as Navigator.
/// Test: supervisor/named_navigator_test.cpp, supervisor/delayed_landmarks_test.cpp, supervisor/guarantee_test.cpp.
class NamedNavigator {
 public:
  explicit NamedNavigator(const core::PoseGaussian& start, const NavigatorOptions& options = {});

  /// Goes on in the map of an earlier session, from the pose in it and with its correlations, as if that session had not
  /// ended: `landmark_of` names its landmarks. Sightings of ranges or bearings alone that had fixed no landmark yet are lost.
  /// PreconditionError where cekf::CompressedEkf refuses the joint estimate, or for a landmark that the map does not have.
  /// Test: supervisor/go_on_test.cpp (equal to 1e-7).
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

  /// All landmarks, in order of id.
  std::vector<core::MapLandmark> map() const;
  /// As Navigator's.
  std::vector<core::MapLandmark> sketch() const { return map(); }
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const { return filter_.joint(ids); }

  const cekf::CompressedEkf& filter() const { return filter_; }

 private:
  /// What came in since the last scan.
  struct Pending {
    std::optional<core::Odometry> motion;
    std::vector<core::Decision> decisions;
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
    std::int64_t step;
  };

  void fit_to(const core::FieldOfView& view);
  core::StepReport observe_thinned(const core::Scan& scan, const std::vector<std::int64_t>& identities);
  core::StepReport step(const NamedScan& scan);
  bool use_fix(const core::AbsoluteFix& fix);
  void predict();
  std::vector<core::AssociationReport> associate(const NamedScan& scan) const;
  void update(const core::Scan& scan, core::StepReport& report);
  void augment(const NamedScan& scan, core::StepReport& report);
  void enter_names(const NamedScan& scan, const core::StepReport& report);
  template <class Call>
  auto all_or_nothing(const Call& call);
  void checkpoint();
  void forget_names();
  void recover(std::size_t events, Pending pending);

  NavigatorOptions options_;
  bool fitted_ = false;  ///< the lengths of the options to the sensor
  cekf::CompressedEkf filter_;
  DelayedLandmarks delayed_;
  std::map<std::int64_t, core::LandmarkId> landmark_of_identity_;
  std::map<core::LandmarkId, int> observations_;
  std::int64_t step_ = 0;
  Pending pending_;
  std::optional<Checkpoint> checkpoint_;
  std::vector<Taken> taken_;  ///< since the checkpoint
};

}  // namespace helixnav::supervisor
