// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/step_report.hpp"
#include "slip/should_be_seen.hpp"

namespace helixnav::supervisor {

/// What became of the landmarks that one scan matched, and that the next should have seen.
struct Vanished {
  std::int64_t step = 0;                  ///< of the scan that did not see them
  std::size_t sensor = 0;                 ///< whose scan it was
  int looks = 0;                          ///< of that sensor since
  std::vector<core::LandmarkId> missing;  ///< nothing is where they should be
  std::vector<core::LandmarkId> unknown;  ///< begun by that scan instead
  int seen = 0;                           ///< matched again
  /// ln P(scan | the vehicle slipped) / P(scan | it did not), without the prior. Slipped, each observation is of something known,
  /// seen from elsewhere: a Poisson process with the mean number of landmarks seen again. Not slipped, each landmark is
  /// seen again as often as they usually are, and new ones appear as often as usual.
  double nats = 0.0;
};

/// How many of the landmarks that one scan saw are seen again by the next, lately on this drive.
class ShareSeen {
 public:
  explicit ShareSeen(double assumed) : assumed_(assumed) {}

  void forget_slowly();
  void count(bool is_seen);
  double share() const;
  /// ln P(seen or not | the vehicle is elsewhere) / P(the same | it is where odometry puts it).
  double nats(bool is_seen, double by_chance) const;

 private:
  static constexpr double assumed_looks = 20.0;  ///< before anything is known, as if seen in so many looks
  double assumed_;
  double seen_ = 0.0;
  double looks_ = 0.0;
};

/// Whether all that was in view of a sensor vanishes from one of its scans to the next, as after a slip, and stays away. A value that
/// rolls back with the belief: O(sensors + landmarks in view) bytes. Test: supervisor/slip/vanished_test.cpp.
class SeenAgain {
 public:
  /// Number of the sensor that took this scan, told by where it is mounted and looks to.
  std::size_t sensor_of(const core::Scan& scan);

  /// Landmarks that the next scan of this sensor is asked about.
  std::vector<core::LandmarkId> watched(std::size_t sensor) const;

  /// A scan that was taken at this step, with its new landmarks begun; `in_view`: of those watched. `chance`: probability that
  /// some of them are matched by chance, asked only if that matters. `slips`: known of the drive so far.
  using Chance = std::function<double(const std::vector<core::LandmarkId>&)>;
  void see(std::int64_t step, std::size_t sensor, const std::vector<core::AssociationReport>& fate,
           const InView& in_view, const association::LandmarkLife& existence, double extraneous_per_scan, int slips,
           const Chance& chance);

  /// A scan for which the vehicle had slipped: what was seen before says nothing about it.
  void start_from(std::size_t sensor, const std::vector<core::AssociationReport>& fate);

  /// A search begins that leaves these out (ascending), so that no scan matches them.
  void leave_out(const std::vector<core::LandmarkId>& ids);

  /// The vehicle is elsewhere: nothing seen before is expected any more.
  void forget();

  /// Something has vanished, and the next scans decide whether it stays away.
  bool is_suspicious() const { return suspicion_.has_value(); }

  /// What has vanished and stayed away, while what came instead is there.
  const Vanished* lost() const { return is_confirmed_ ? &*suspicion_ : nullptr; }

 private:
  struct Again;
  /// What one sensor saw: scans of others, which look elsewhere, come in between.
  struct BySensor {
    core::Pose2 T_robot_sensor;
    double min_bearing_rad = 0.0, max_bearing_rad = 0.0;
    std::vector<core::LandmarkId> last = {};  ///< matched or begun by its last scan
    ShareSeen surely{0.7};
    ShareSeen perhaps{0.5};
  };
  Again again(const BySensor& by, const std::vector<core::LandmarkId>& ids,
              const std::vector<core::AssociationReport>& fate, const InView& in_view, const Chance& chance) const;
  Vanished weigh(const BySensor& by, const std::vector<core::AssociationReport>& fate, const InView& in_view,
                 const association::LandmarkLife& existence, double extraneous_per_scan, const Chance& chance) const;
  void judge(std::size_t sensor, const std::vector<core::AssociationReport>& fate, const InView& in_view,
             const Chance& chance);

  std::vector<BySensor> sensors_;
  std::optional<Vanished> suspicion_;
  bool is_confirmed_ = false;
};

}  // namespace helixnav::supervisor
