// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// What became of the landmarks that one scan matched, and that the next should have seen.
struct Vanished {
  std::int64_t step = 0;                  ///< of the scan that did not see them
  std::vector<core::LandmarkId> missing;  ///< nothing is where they should be
  std::vector<core::LandmarkId> unknown;  ///< begun by that scan instead
  int seen = 0;                           ///< matched again
  /// ln P(scan | the vehicle slipped) / P(scan | it did not), without the prior. Slipped, each observation is of something known,
  /// seen from elsewhere: a Poisson process with the mean number of landmarks seen again. Not slipped, each landmark is
  /// seen again as often as they usually are, and new ones appear as often as usual.
  double nats = 0.0;
};

/// Whether all that was in view vanishes from one scan to the next, as after a slip, and stays away. A value that rolls back with the
/// belief: O(landmarks in view) bytes. Test: supervisor/slip/vanished_test.cpp.
class SeenAgain {
 public:
  /// A scan that was taken at this step, with its new landmarks begun; `expected`: mapped landmarks that it should have seen, those
  /// that it did see may be among them. `slips`: known of the drive so far.
  void see(std::int64_t step, const std::vector<core::AssociationReport>& fate,
           const std::vector<core::LandmarkId>& expected, const association::LandmarkLife& existence,
           double extraneous_per_scan, int slips);

  /// A scan for which the vehicle had slipped, or in a search: what was seen before says nothing about it.
  void start_from(const std::vector<core::AssociationReport>& fate);

  /// Something has vanished, and the next scans decide whether it stays away.
  bool is_suspicious() const { return suspicion_.has_value(); }

  /// What has vanished and stayed away, while what came instead is there.
  const Vanished* lost() const { return is_confirmed_ ? &*suspicion_ : nullptr; }

 private:
  double share() const;
  Vanished weigh(const std::vector<core::AssociationReport>& fate, const std::vector<core::LandmarkId>& expected,
                 const association::LandmarkLife& existence, double extraneous_per_scan) const;
  void count(const std::vector<core::AssociationReport>& fate, const std::vector<core::LandmarkId>& expected);
  void judge(std::int64_t step, const std::vector<core::AssociationReport>& fate,
             const std::vector<core::LandmarkId>& expected);

  std::vector<core::LandmarkId> last_;  ///< matched or begun by the last scan
  double again_ = 0.0;
  double expected_ = 0.0;
  std::optional<Vanished> suspicion_;
  bool is_confirmed_ = false;
};

}  // namespace helixnav::supervisor
