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
#include "helixnav/supervisor/factored_map.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

class NavigationLoop;

/// Navigates: keeps the pose and the landmark map up to date as events come in, with unknown data association
/// (NamedNavigator is for observations known by name). Every scan runs once through the loop: predict, associate,
/// update, augment, update existence, switch region. When a return to old ground is too ambiguous to be associated scan
/// by scan, a search begins: mapping continues with the old landmarks excluded, a particle filter finds where on the
/// old map the vehicle is, and when a constellation of new landmarks matches old ones, and no other place fits as well,
/// the map is closed there. If old landmarks are missing while new ones spawn, the navigator rolls back and processes
/// the last scans again in a search (docs/adr/0009-integrity.md); that scan costs as much as they did. After a closing,
/// the drive so far is solved as a whole, and the scan that closes the map takes time proportional to it
/// (docs/adr/0010-solving-the-drive.md, SearchOptions::smooth_up_to_scans). Source: hybrid_masson2003 §3, PROTOTYPE.
/// The map frame is that of the start pose; nothing here knows about ground truth, files or displays.
///
/// Strong guarantee: a call that throws (PreconditionError for events that core::check rejects, NumericalError for a
/// numerical failure, std::bad_alloc) leaves everything as it was. The navigator rolls back to its last checkpoint and
/// processes again what has come in since, so a failure costs as much as those scans did, and nothing is copied as long
/// as none occurs; covariances between landmarks outside the active region are restored to round-off, everything else
/// bit for bit. Test: supervisor/navigator_test.cpp, supervisor/closing/closing_test.cpp,
/// supervisor/guarantee_test.cpp.
class Navigator {
 public:
  /// PreconditionError for a start that core::check_start rejects.
  explicit Navigator(const core::PoseGaussian& start, const NavigatorOptions& options = {});
  /// Continues in the map of an earlier session, from the pose in it and with its correlations. Landmarks created from
  /// now on get names above those of the map. PreconditionError if cekf::CompressedEkf rejects the joint estimate, and
  /// for a joined map, which has no end pose.
  static Navigator go_on_in(const core::JointMap& earlier, const NavigatorOptions& options = {});
  ~Navigator();
  Navigator(Navigator&&) noexcept;
  Navigator& operator=(Navigator&&) noexcept;

  /// For a session that begins somewhere on the earlier map, or elsewhere: it maps on its own and, whenever a fifth of
  /// the landmarks around the vehicle are new, queries that map for their place (relocalize::ask, α = 1e-5 for the
  /// whole session). Once an answer is closed and its pairs do not contradict each other, the two become one map in the
  /// frame of the earlier one (core::PlacedDecision), and mapping continues in it; a doubtful answer leaves them
  /// separate. Only before the first scan, and with at least one mature landmark in the map: otherwise
  /// PreconditionError. Test: supervisor/placing/find_place_test.cpp.
  void look_for_place_in(const core::JointMap& earlier);

  /// Any event: move, observe, fix or lose. Returns the report for a scan, nothing for the others.
  std::optional<core::StepReport> take(const core::Event& event);

  /// Accumulates motion; it is applied to the filter with the next scan or fix (exact, see core::chain).
  void move(const core::Odometry& odometry);

  /// One scan.
  core::StepReport observe(const core::Scan& scan);

  /// A position fix in the map frame: pending motion is predicted, then the fix updates the pose if its NIS passes the
  /// gate. The decision goes into the report of the next scan. True if it was used. While the vehicle's place is
  /// unknown, because it was carried (lose()) or is looking for its place on an earlier map, fixes are not used.
  bool fix(const core::AbsoluteFix& fix);

  /// The vehicle has been moved by something other than its wheels since the previous event. What was mapped so far,
  /// its mature landmarks with all correlations, is kept apart, and the drive continues as a separate part, whose frame
  /// is where it begins; the landmarks mapped before are not matched. Its place is sought on all parts kept apart, as
  /// in look_for_place_in(); once it is found, the two become one map in the frame of the earlier one. An open search
  /// ends undecided. Decisions go into the report of the next scan (core::CarriedDecision). A part with fewer than five
  /// landmarks could never be found and is dropped; of more than 3000, the nearest are kept. O(N²).
  /// Test: supervisor/placing/carried_test.cpp.
  void lose(const core::Lost& lost);

  /// [part] the maps whose pose relative to the present one is unknown: parts of the drive from before the vehicle was
  /// carried and, as part 0, the earlier map of look_for_place_in().
  std::map<int, core::JointMap> maps_apart() const;

  /// Pose at the last scan or fix; anywhere on the map if the vehicle may have been carried (supervisor/slip/untied_test.cpp)
  core::PoseGaussian pose() const;

  /// All landmarks with their state, in order of id. O(landmarks · q²): for the end of a run, not for every step. If
  /// the map is larger than the filter, the atlas is solved first.
  std::vector<core::MapLandmark> map() const;

  /// The same for display: landmarks that have left the filter are where they were last solved, with the covariance
  /// they had when they left it. O(landmarks).
  std::vector<core::MapLandmark> sketch() const;

  /// Joint estimate of the pose and of the given landmarks of the map, in the order given, wherever they are. O(n²)
  /// times the largest separator of the map.
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const;

  /// The map as factors, for a session that continues in it, if it is larger than MapOptions::whole and the drive was kept
  /// (SearchOptions::smooth_up_to_scans), or continued in such a map; else nothing: use joint_map. O(N).
  /// Test: supervisor/placing/large_map_test.cpp.
  std::optional<core::JointMap> factored_map(FactoredMap how = FactoredMap::whole) const;

  /// The filter; it holds all landmarks up to MapOptions::whole, and beyond that those near the vehicle.
  const cekf::CompressedEkf& filter() const;

 private:
  explicit Navigator(std::unique_ptr<NavigationLoop> loop);

  std::unique_ptr<NavigationLoop> loop_;
};

}  // namespace helixnav::supervisor
