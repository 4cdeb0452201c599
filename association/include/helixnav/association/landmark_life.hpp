// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/map_appearance.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::association {

/// Evidence for a landmark's existence, in nats. A look is a scan taken at least `look_distance_m` from where the last
/// look of the same kind at this landmark was taken: a sensor at rest repeats the same evidence. Clutter is the
/// exception: a landmark that was seen from only one place dies once it has gone unseen from there for so many scans
/// that one seen half as often as assumed would be missed in all of them once in a thousand times. Otherwise a
/// stationary vehicle would collect all the clutter of its stop.
struct LifeOptions {
  double detection_probability = 0.7;  ///< that an expected landmark is seen in one look, occlusion included
  double false_hit_probability = 0.1;  ///< that clutter is taken for one that does not exist
  double look_distance_m = 0.25;
  double birth_log_odds = 0.0;
  double max_log_odds = 8.0;     ///< bound, so that every landmark can die
  int mature_looks = 3;          ///< hits, birth included, and
  double mature_log_odds = 3.0;  ///< log-odds that make a tentative landmark mature
  double tentative_death_log_odds = -2.0;
  double tentative_patience_m = 30.0;  ///< a tentative landmark unseen over this distance dies
  bool mature_may_die = true;
  double mature_death_log_odds = -6.0;
};

/// The record of one landmark's existence.
struct LandmarkRecord {
  core::LandmarkId id = core::no_landmark;
  core::LandmarkState state = core::LandmarkState::tentative;
  double log_odds = 0.0;
  int observations = 0;    ///< scans that saw it, looks or not
  int hits = 0;            ///< looks that saw it and were used, birth included: they determine its position
  int misses = 0;          ///< looks that should have seen it
  int unseen_at_rest = 0;  ///< scans since it was last seen, taken from where it was last seen
  Eigen::Vector2d last_hit_at_m = Eigen::Vector2d::Zero();  ///< position of the sensor
  Eigen::Vector2d last_miss_at_m = Eigen::Vector2d::Zero();
  double born_path_m = 0.0;  ///< length of the drive at its birth
  double last_seen_path_m = 0.0;
  double last_passed_path_m = 0.0;  ///< see LandmarkLife::pass
};

/// An observation that no estimate uses because it may be of a landmark, or of something unmapped.
struct UnusedSighting {
  core::LandmarkId id = core::no_landmark;
  double nats = 0.0;  ///< by which the landmark explains the observation better than an unmapped object does
};

/// What one scan changed. The owner of the filter removes the dead landmarks from it.
struct LifeChanges {
  std::vector<core::LandmarkId> matured;
  std::vector<core::LandmarkId> died;
};

/// Which landmarks are tentative, mature or dead: bookkeeping only, a value type without a filter, copied with a
/// snapshot. log-odds += ln(P_D/P_F) for a hit and ln((1−P_D)/(1−P_F)) for a miss. Dead landmarks are no longer
/// recorded. Cost per scan O((seen + expected) log n + n + seen · expected). Test: association/landmark_life_test.cpp.
class LandmarkLife {
 public:
  /// PreconditionError unless 0 < P_F < P_D < 1, deaths are below birth and maturity is above it.
  explicit LandmarkLife(const LifeOptions& options = {});

  /// The vehicle has driven on. Distance driven without scans counts; displacement of the estimate by a correction does
  /// not.
  void drive(double length_m) { path_m_ += length_m; }

  /// Landmarks at the edge of the sensor's view that the next scan to be observed did not see; whether it should have
  /// is uncertain. For a mature landmark, one whole drive past it is one miss, and a drive past ends after
  /// tentative_patience_m: if landmarks that are gone were seen only from afar, nothing else refutes them.
  /// PreconditionError, with nothing changed, for an id that is not recorded.
  void pass(const std::vector<core::LandmarkId>& unseen_at_rim);

  /// Notes a scan before it is observed. True if what it does not see is not evidence, because the sensor may be
  /// blinded: it sees nothing at all where three or more landmarks should be, as did the scan before it. Such scans
  /// miss all landmarks for one reason, and count once.
  bool note_if_blinded(std::size_t observations, std::size_t expected);

  /// One scan taken with the sensor at `sensor_m`, world frame. `seen`: matched landmarks. `born`: landmarks it
  /// created. `expected`: those it should have seen, with a margin inside the field of view; seen ones may be among
  /// them. A landmark next to an ambiguous observation belongs in neither list. `seen_nats`: [seen] what class and size
  /// add to the evidence of a hit, or empty. `unused`: such a look adds its nats to the log-odds, at most those of a
  /// hit, but is not one of the looks by which a landmark matures, because it has not contributed to its position.
  /// PreconditionError, with nothing changed, for a seen, unused or expected id that is not recorded, or a born one
  /// that is.
  LifeChanges observe(const Eigen::Vector2d& sensor_m, const std::vector<core::LandmarkId>& seen,
                      const std::vector<core::LandmarkId>& born, const std::vector<core::LandmarkId>& expected,
                      const std::vector<double>& seen_nats = {}, const std::vector<UnusedSighting>& unused = {});

  /// What the landmarks look like. This follows them: a landmark that dies or is merged takes it along.
  const core::MapAppearance& appearance() const { return appearance_; }

  /// Notes what an observation looked like; no_landmark: it was of no landmark, or of one that is not recorded.
  void look(core::LandmarkId id, const core::Appearance& seen) {
    appearance_.count(seen);
    if (contains(id)) appearance_.see(id, seen);
  }

  /// Adopts what a recorded landmark of an earlier drive looks like. PreconditionError for an id that is not recorded.
  void adopt_appearance(core::LandmarkId id, const core::LandmarkAppearance& known) {
    appearance_.adopt(record(id).id, known);
  }

  /// Adopts a landmark of an earlier drive. PreconditionError for an id that is already recorded.
  void adopt(const LandmarkRecord& record);

  /// Everything so far was in another frame: positions of the sensor are transformed, evidence is kept.
  void change_frame(const core::Pose2& T_new_old);

  /// Removes a landmark that left the filter for another reason.
  void remove(core::LandmarkId id);

  /// Two landmarks were the same: sightings of `removed` count for `kept`. PreconditionError unless both are recorded.
  void merge(core::LandmarkId kept, core::LandmarkId removed);

  bool contains(core::LandmarkId id) const;
  const LandmarkRecord& record(core::LandmarkId id) const;  ///< PreconditionError when it is not recorded
  core::LandmarkState state(core::LandmarkId id) const;     ///< dead when it is not recorded
  const std::vector<LandmarkRecord>& records() const { return records_; }  ///< ascending by id

  /// Average number of landmarks created per scan: clutter and new ones together. 0 before the first scan.
  double born_per_scan() const { return scans_ == 0 ? 0.0 : static_cast<double>(born_) / static_cast<double>(scans_); }
  /// The same, as if ten scans before the drive had created `assumed` landmarks each.
  double born_per_scan(double assumed) const {
    constexpr double before = 10.0;
    return (static_cast<double>(born_) + before * assumed) / (static_cast<double>(scans_) + before);
  }
  /// Average number of landmarks seen again per scan. 0 before the first scan.
  double seen_per_scan() const { return scans_ == 0 ? 0.0 : static_cast<double>(seen_) / static_cast<double>(scans_); }

  /// Call once the sensor is known; counts so far are kept.
  void set_lengths(double look_distance_m, double tentative_patience_m);

  /// Odds that a landmark exists: of those created on this drive, the number that matured against the number that died
  /// tentative (one of each before any), times the evidence of the looks at this one.
  double odds(core::LandmarkId id) const;

  /// Length of the drive so far, along which last_seen_path_m is measured.
  double path_m() const { return path_m_; }

 private:
  LandmarkRecord* find(core::LandmarkId id);
  const LandmarkRecord* find(core::LandmarkId id) const;
  void check_scan(const std::vector<core::LandmarkId>& seen, const std::vector<core::LandmarkId>& born,
                  const std::vector<core::LandmarkId>& expected, const std::vector<UnusedSighting>& unused) const;
  void hit(LandmarkRecord& record, const Eigen::Vector2d& sensor_m, double appearance_nats);
  void count_unused(LandmarkRecord& record, const Eigen::Vector2d& sensor_m, double nats) const;
  bool note_look(LandmarkRecord& record, const Eigen::Vector2d& sensor_m) const;
  void miss(LandmarkRecord& record, const Eigen::Vector2d& sensor_m);
  void count_unseen_at_rest(LandmarkRecord& record, const Eigen::Vector2d& sensor_m) const;
  bool is_dying(const LandmarkRecord& record) const;

  LifeOptions options_;
  double hit_nats_;
  double miss_nats_;
  int most_unseen_at_rest_ = 0;
  std::vector<LandmarkRecord> records_;
  core::MapAppearance appearance_;
  double path_m_ = 0.0;
  std::size_t scans_ = 0, born_ = 0, seen_ = 0;
  bool saw_nothing_ = false;  ///< in the last scan, where three or more should have been seen
  std::size_t matured_ = 0, died_tentative_ = 0;
};

}  // namespace helixnav::association
