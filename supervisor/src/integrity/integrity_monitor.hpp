// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// Whether what the map predicts is still there. A wrong match turns the pose while its covariance shrinks: afterwards no
/// old landmark falls into its gate, everything in view is mapped anew, and every innovation looks right. The evidence is
/// that old landmarks are missing while new ones spawn. Each landmark counts once, however often it is looked for.
/// The pose is confirmed when two scans in a row match two revisited landmarks each (clutter may do it once); all counts
/// restart there.
/// Cost of a scan: O(expected + landmarks returned to recently). Source: PROTOTYPE §7.
/// Test: supervisor/integrity_monitor_test.cpp.
class IntegrityMonitor {
 public:
  /// Evidence for a wrong pose since the pose was last confirmed.
  struct Evidence {
    int missing = 0;    ///< revisited, looked for, not seen
    int seen = 0;       ///< revisited and mostly seen
    int spawned = 0;    ///< matured since
    double nats = 0.0;  ///< log-likelihood ratio of "wrong" against "right" of missing and seen
  };

  /// One scan, before `life` is updated with it. `expected`: landmarks that should be in view; `matched`:
  /// those that were seen.
  void observe(const association::LandmarkLife& life, const std::vector<core::LandmarkId>& expected,
               const std::vector<core::LandmarkId>& matched, double old_after_m);

  /// A closing recognised these landmarks at `path_m` of the drive. They count as revisited, as others do after a
  /// match, and confirm the pose from here on; without them only landmarks that the closing missed would be looked for.
  void close(double path_m, const std::vector<core::LandmarkId>& recognised);

  /// No revisited landmark was looked for since the pose was confirmed.
  bool is_clear() const { return clear_; }
  Evidence evidence(const association::LandmarkLife& life, const IntegrityLimits& limits) const;
  bool is_lost(const association::LandmarkLife& life, const IntegrityLimits& limits) const;

 private:
  struct Returned {
    int looks = 0;  ///< since the pose was confirmed
    int hits = 0;
    double last_look_path_m = 0.0;
  };

  Returned* find_returned(const association::LandmarkLife& life, core::LandmarkId id, double old_after_m);

  std::map<core::LandmarkId, Returned> returned_;
  int hits_before_ = 0;  ///< revisited landmarks matched in the previous scan
  bool clear_ = true;
  std::optional<double> clear_path_m_;  ///< when clear_ was last true, or the first scan came
};

}  // namespace helixnav::supervisor
