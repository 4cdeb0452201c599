// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "helixnav/association/associate.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/delayed_landmarks.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

struct AmbiguousReturn;
class BranchJournal;
class DriveLog;
struct Gating;
class History;
class MissingSpawn;
class Probation;
class Search;
class Track;

/// Every length stands here for a sensor that sees reference_reach_m far; the navigator fits it to the sensor that the
/// first scan speaks of (lengths.hpp).
struct NavigatorOptions {
  bool fit_lengths = true;  ///< false: they are used as they stand
  cekf::FilterOptions filter;
  association::Method method = association::Method::likelihood_ratio;
  association::Options association;
  association::Gates gates;
  association::LifeOptions life;
  SearchOptions search;
  DelayedOptions delayed;            ///< of landmarks known by name and seen as a range or a bearing only
  double fix_probability = 0.999;    ///< χ² gate of an absolute fix
  double extraneous_per_scan = 1.0;  ///< observations of no mapped landmark: clutter and new ones together
  double candidate_sigmas = 4.0;     ///< how far the search for candidates reaches
  double view_margin_m = 2.0;        ///< so far inside the field of view a landmark is expected to be seen
};

/// Navigates: keeps the pose and the landmark map up to date as events come in, with unknown data association.
/// Every scan runs once through the loop: predict, associate, update, augment, bury, switch region. When old ground comes
/// into view that cannot be told apart scan by scan, a search begins: mapping goes on with the old landmarks excluded, a
/// particle filter finds where on the old map the vehicle is, and when a constellation of new landmarks stands on old
/// ones, and nowhere else as well, the map is closed there. Where old landmarks are missing and new ones spawn, the last
/// scans are gone through again in a search from before (docs/adr/0009-doubt.md); that scan costs as much as they did. After a
/// closing the drive so far is solved as a whole, and the scan that closes costs time proportional to it
/// (docs/adr/0010-solving-the-drive.md, SearchOptions::smooth_up_to_scans).
/// Source: hybrid_masson2003 §3, PROTOTYPE.
/// The map frame is that of the start pose; nothing here knows of truth, files or screens.
/// Throws what its filter throws (NumericalError, PreconditionError); the map is then as before the scan's failing verb.
/// Test: supervisor/navigator_test.cpp, supervisor/closing_test.cpp.
class Navigator {
 public:
  explicit Navigator(const core::PoseGaussian& start, const NavigatorOptions& options = {});
  ~Navigator();
  Navigator(Navigator&&) noexcept;
  Navigator& operator=(Navigator&&) noexcept;

  /// Collects motion; it reaches the filter with the next scan (exact, see core::chain).
  void move(const core::Odometry& odometry);

  /// One scan, association unknown.
  core::StepReport observe(const core::Scan& scan);

  /// One scan whose observations are known by name: the same identity is the same landmark, a negative one is none;
  /// of a new identity twice in one scan the first counts. PreconditionError unless there is one identity an observation,
  /// with everything as it was.
  core::StepReport observe(const core::Scan& scan, const std::vector<std::int64_t>& identities);

  /// A position fix in the map frame: motion pending is predicted, then the fix updates the pose when its NIS passes the
  /// gate. The decision (kind "fix") goes into the report of the next scan. True when it was used.
  bool fix(const core::AbsoluteFix& fix);

  /// Pose at the last scan or fix.
  core::PoseGaussian pose() const { return filter_.pose(); }

  /// All landmarks with their state, in order of id. O(landmarks · q²): for the end of a run, not for every step.
  std::vector<core::MapLandmark> map() const;

  const cekf::CompressedEkf& filter() const { return filter_; }

 private:
  void fit_to(const core::FieldOfView& view);
  core::StepReport navigate(const core::Scan& scan);
  void keep_in_mind(const core::Scan& scan, const core::StepReport& report);
  bool has_got_lost() const;
  core::StepReport search_from_before(core::StepReport report);
  void predict();
  std::vector<core::LandmarkId> candidates_of(const core::Scan& scan) const;
  std::vector<AmbiguousReturn> old_ones_in_gate(const core::Scan& scan, const Gating& gating) const;
  bool is_lost(const std::vector<AmbiguousReturn>& returns, core::StepReport& report) const;
  void begin_search();
  void pursue_search(const core::Scan& scan, core::StepReport& report);
  void close(const core::Scan& scan, const std::vector<pf_relocalize::ConstellationPair>& pairs,
             core::StepReport& report);
  void end_search();
  void smooth(core::StepReport& report);
  std::vector<core::AssociationReport> associate(const core::Scan& scan, const Gating& gating,
                                                 const std::vector<AmbiguousReturn>& returns);
  void hold_lonely_returns(const std::vector<AmbiguousReturn>& returns, std::vector<core::AssociationReport>& reports);
  std::vector<core::AssociationReport> known_associations(const core::Scan& scan,
                                                          const std::vector<std::int64_t>& identities) const;
  void update(const core::Scan& scan, core::StepReport& report);
  void augment(const core::Scan& scan, core::StepReport& report);
  void augment_known(const core::Scan& scan, const std::vector<std::int64_t>& identities, core::StepReport& report);
  void live_and_let_die(const core::Scan& scan, core::StepReport& report);
  void forgive_what_may_be_elsewhere(const std::vector<core::LandmarkId>& seen,
                                     std::vector<core::LandmarkId>& expected) const;
  void remember(const std::vector<std::int64_t>& identities, const core::StepReport& report);
  core::StepReport close_step(const core::Scan& scan, core::StepReport report);

  NavigatorOptions options_;
  bool fitted_ = false;  ///< the lengths of options_, to the sensor
  core::FieldOfView view_;
  cekf::CompressedEkf filter_;
  association::LandmarkLife life_;
  std::optional<core::Odometry> motion_;   ///< since the last scan
  double driven_m_ = 0.0;                  ///< its length along the road
  std::vector<core::Decision> decisions_;  ///< since the last scan
  std::int64_t step_ = 0;

  std::unique_ptr<Track> track_;
  std::unique_ptr<DriveLog> drive_;         ///< to be solved as a whole after a closing
  std::unique_ptr<Search> search_;          ///< while a question is open
  std::unique_ptr<BranchJournal> journal_;  ///< of the search, when closing is by replay
  std::unique_ptr<Probation> probation_;
  std::unique_ptr<MissingSpawn> doubts_;  ///< while no question is open, and …
  std::unique_ptr<History> history_;      ///< … what to go back to when they grow
  std::uint64_t searches_ = 0;

  // Known association only: who is who, and how often it was seen.
  std::map<std::int64_t, core::LandmarkId> landmark_of_identity_;
  std::map<core::LandmarkId, int> observations_of_known_;
  DelayedLandmarks delayed_;
};

}  // namespace helixnav::supervisor
