// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

class NavigationLoop;

/// Navigates: keeps the pose and the landmark map up to date as events come in, with unknown data association
/// (NamedNavigator is for observations known by name). Every scan runs once through the loop: predict, associate,
/// update, augment, update existence, switch region. When a return to old ground is too ambiguous to be associated scan
/// by scan, a search begins: mapping goes on with the old landmarks excluded, a particle filter finds where on the old
/// map the vehicle is, and when a constellation of new landmarks matches old ones, and nowhere else as well, the map is
/// closed there. Where old landmarks are missing and new ones spawn, the navigator rolls back and processes the last
/// scans again in a search (docs/adr/0009-integrity.md); that scan costs as much as they did. After a closing the drive
/// so far is solved as a whole, and the scan that closes costs time proportional to it
/// (docs/adr/0010-solving-the-drive.md, SearchOptions::smooth_up_to_scans). Source: hybrid_masson2003 §3, PROTOTYPE.
/// The map frame is that of the start pose; nothing here knows of truth, files or screens.
///
/// Strong guarantee: a call that throws (PreconditionError for events that core::check refuses, NumericalError for
/// broken mathematics, std::bad_alloc) leaves everything as before it. It rolls back to its last checkpoint and
/// processes what came since again, so that a failure costs as much as these scans did, and nothing is copied as long
/// as none occurs; covariances between landmarks outside the active region come back to round-off, everything else bit
/// for bit. Test: supervisor/navigator_test.cpp, supervisor/closing/closing_test.cpp, supervisor/guarantee_test.cpp.
class Navigator {
 public:
  /// PreconditionError for a start that core::check_start refuses.
  explicit Navigator(const core::PoseGaussian& start, const NavigatorOptions& options = {});
  /// Goes on in the map of an earlier session, from the pose in it and with its correlations. Names given to landmarks from
  /// now on are above those of the map. PreconditionError where cekf::CompressedEkf refuses the joint estimate, and for a
  /// joined map, which has no end.
  static Navigator go_on_in(const core::JointMap& earlier, const NavigatorOptions& options = {});
  ~Navigator();
  Navigator(Navigator&&) noexcept;
  Navigator& operator=(Navigator&&) noexcept;

  /// This session begins somewhere on the earlier map, or elsewhere: it maps on its own and asks that map, whenever a fifth of
  /// the landmarks about the vehicle are new, where they are (relocalize::ask, α = 1e-5 for the whole session). Once an answer
  /// is closed and its pairs do not contradict each other, both become one map in the frame of the earlier one
  /// (core::PlacedDecision), in which mapping goes on; a doubtful answer leaves both apart. Only before the first scan, and
  /// with at least one mature landmark: PreconditionError. Test: supervisor/placing/find_place_test.cpp.
  void look_for_place_in(const core::JointMap& earlier);

  /// Any event: move, observe, fix or lose. The report of a scan, nothing for others.
  std::optional<core::StepReport> take(const core::Event& event);

  /// Collects motion; it reaches the filter with the next scan or fix (exact, see core::chain).
  void move(const core::Odometry& odometry);

  /// One scan.
  core::StepReport observe(const core::Scan& scan);

  /// A position fix in the map frame: motion pending is predicted, then the fix updates the pose when its NIS passes the
  /// gate. The decision goes into the report of the next scan. True when it was used. Not used where the vehicle was carried
  /// (lose()) or looks for its place on an earlier map, until that is found.
  bool fix(const core::AbsoluteFix& fix);

  /// The vehicle was moved by something else than its wheels since the event before. What was mapped so far, its mature
  /// landmarks with all correlations, is kept apart, and the drive goes on as a part of its own, whose frame is where it begins;
  /// the landmarks mapped before are not matched. Its place is sought on all parts kept apart as look_for_place_in() does;
  /// where it is found, the two become one map in the frame of the earlier one. A search that is open ends undecided. Decisions
  /// go into the report of the next scan (core::CarriedDecision). A part of fewer than five landmarks could never be found
  /// and is dropped; of more than 3000 the nearest are kept. O(N²). Test: supervisor/placing/carried_test.cpp.
  void lose(const core::Lost& lost);

  /// [part] the maps of which it is not known how the present one lies to them: parts of the drive from before the vehicle
  /// was carried, and as part 0 the earlier map of look_for_place_in().
  std::map<int, core::JointMap> maps_apart() const;

  /// Pose at the last scan or fix.
  core::PoseGaussian pose() const;

  /// All landmarks with their state, in order of id. O(landmarks · q²): for the end of a run, not for every step. Of a map that
  /// is larger than the filter the atlas is solved first.
  std::vector<core::MapLandmark> map() const;

  /// The same for a picture: landmarks that the filter has left out are where they were solved last, with the covariance
  /// that they had when they were left. O(landmarks).
  std::vector<core::MapLandmark> sketch() const;

  /// Joint estimate of the pose and of landmarks of the map in the order given, wherever they are. O(n²) times the largest
  /// separator of the map.
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const;

  /// The filter; it holds the landmarks near the vehicle, all of them up to MapOptions::window.
  const cekf::CompressedEkf& filter() const;

 private:
  explicit Navigator(std::unique_ptr<NavigationLoop> loop);

  std::unique_ptr<NavigationLoop> loop_;
};

}  // namespace helixnav::supervisor
