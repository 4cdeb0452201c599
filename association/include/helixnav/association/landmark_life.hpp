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
/// look of the same kind at this landmark was taken: a sensor at rest repeats the same evidence. But for clutter: what was seen from
/// one place only, and from there not again in as many scans as one that is seen half as often as assumed would be missed in once in
/// a thousand times, dies. A vehicle that stands would gather all the clutter of its pause otherwise.
struct LifeOptions {
  double detection_probability = 0.7;  ///< that an expected landmark is seen in one look, occlusion included
  double false_hit_probability = 0.1;  ///< that clutter stands in for one that does not exist
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
  int hits = 0;            ///< looks that saw it and were used, birth included: what has placed it
  int misses = 0;          ///< looks that should have seen it
  int unseen_at_rest = 0;  ///< scans since it was last seen, from where it was seen last
  Eigen::Vector2d last_hit_at_m = Eigen::Vector2d::Zero();  ///< place of the sensor
  Eigen::Vector2d last_miss_at_m = Eigen::Vector2d::Zero();
  double born_path_m = 0.0;  ///< length of the drive then
  double last_seen_path_m = 0.0;
  double last_passed_path_m = 0.0;  ///< see LandmarkLife::pass
};

/// An observation that no estimate uses because it may be of a landmark, or of nothing that is mapped.
struct UnusedSighting {
  core::LandmarkId id = core::no_landmark;
  double nats = 0.0;  ///< by which the landmark explains what was seen better than something in no map
};

/// What one scan changed. The owner of the filter removes the dead ones from it.
struct LifeChanges {
  std::vector<core::LandmarkId> matured;
  std::vector<core::LandmarkId> died;
};

/// Which landmarks are tentative, mature or dead: bookkeeping only, a value without a filter, copied with a snapshot.
/// log-odds += ln(P_D/P_F) for a hit and ln((1−P_D)/(1−P_F)) for a miss. Dead landmarks are no longer recorded.
/// Cost of a scan O((seen + expected) log n + n + seen · expected). Test: association/landmark_life_test.cpp.
class LandmarkLife {
 public:
  /// PreconditionError unless 0 < P_F < P_D < 1, deaths lie below birth and maturity above it.
  explicit LandmarkLife(const LifeOptions& options = {});

  /// The vehicle has driven on. What is driven without scans counts, and what a correction moves the estimate does not.
  void drive(double length_m) { path_m_ += length_m; }

  /// Landmarks at the rim of what the sensor sees that the next scan to be observed did not see; whether it should have is
  /// uncertain. Of a mature one a whole drive past it is one miss, and a drive past ends after tentative_patience_m: where
  /// landmarks that are gone were seen from afar only, nothing else refutes them. PreconditionError, with nothing changed,
  /// for an id that is not recorded.
  void pass(const std::vector<core::LandmarkId>& unseen_at_rim);

  /// Notes a scan before it is observed. True where what it does not see is no evidence, because the sensor may be blinded: it sees nothing at all where
  /// three landmarks or more should be, and so did the scan before it. Such scans miss all landmarks for one reason, and count once.
  bool note_if_blinded(std::size_t observations, std::size_t expected);

  /// One scan taken with the sensor at `sensor_m`, world frame. `seen`: matched landmarks. `born`: those that it began.
  /// `expected`: those it should have seen, with a margin inside the field of view; seen ones may be among them. A
  /// landmark beside an ambiguous observation belongs in neither list. `seen_nats`: [seen] what class and size add to a hit's
  /// evidence, or empty. `unused`: such a look adds its nats to the log-odds, at most those of a hit, and is none of the looks
  /// that a landmark matures by, because it has not placed it. PreconditionError, with nothing changed, for a
  /// seen, unused or expected id that is not recorded or a born one that is.
  LifeChanges observe(const Eigen::Vector2d& sensor_m, const std::vector<core::LandmarkId>& seen,
                      const std::vector<core::LandmarkId>& born, const std::vector<core::LandmarkId>& expected,
                      const std::vector<double>& seen_nats = {}, const std::vector<UnusedSighting>& unused = {});

  /// What the landmarks look like. It goes with them: a landmark that dies or is merged takes it along.
  const core::MapAppearance& appearance() const { return appearance_; }

  /// An observation looked so; no_landmark: of none, or of one that is not recorded.
  void look(core::LandmarkId id, const core::Appearance& seen) {
    appearance_.count(seen);
    if (contains(id)) appearance_.see(id, seen);
  }

  /// A recorded landmark of an earlier drive looks so. PreconditionError for an id that is not recorded.
  void adopt_appearance(core::LandmarkId id, const core::LandmarkAppearance& known) {
    appearance_.adopt(record(id).id, known);
  }

  /// A landmark of an earlier drive. PreconditionError for an id that is recorded.
  void adopt(const LandmarkRecord& record);

  /// Everything so far was in another frame: places of the sensor are moved, evidence stays.
  void change_frame(const core::Pose2& T_new_old);

  /// A landmark that the filter lost for another reason.
  void remove(core::LandmarkId id);

  /// Two landmarks were one: what was seen of `removed` counts for `kept`. PreconditionError unless both are recorded.
  void merge(core::LandmarkId kept, core::LandmarkId removed);

  bool contains(core::LandmarkId id) const;
  const LandmarkRecord& record(core::LandmarkId id) const;  ///< PreconditionError when it is not recorded
  core::LandmarkState state(core::LandmarkId id) const;     ///< dead when it is not recorded
  const std::vector<LandmarkRecord>& records() const { return records_; }  ///< ascending by id

  /// Landmarks begun in one scan, on average: clutter and new ones together. 0 before the first scan.
  double born_per_scan() const { return scans_ == 0 ? 0.0 : static_cast<double>(born_) / static_cast<double>(scans_); }
  /// The same, as if ten scans had begun `assumed` each before the drive.
  double born_per_scan(double assumed) const {
    constexpr double before = 10.0;
    return (static_cast<double>(born_) + before * assumed) / (static_cast<double>(scans_) + before);
  }
  /// Landmarks seen again in one scan, on average. 0 before the first scan.
  double seen_per_scan() const { return scans_ == 0 ? 0.0 : static_cast<double>(seen_) / static_cast<double>(scans_); }

  /// Once the sensor is known; what was counted stays.
  void set_lengths(double look_distance_m, double tentative_patience_m);

  /// Odds that a landmark exists: of those begun on this drive, as many that matured to as many that died tentative (one of
  /// each before any), times what looks at this one say.
  double odds(core::LandmarkId id) const;

  /// Length of the drive so far, what last_seen_path_m is measured on.
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
  bool saw_nothing_ = false;  ///< in the last scan, where three or more should have been
  std::size_t matured_ = 0, died_tentative_ = 0;
};

}  // namespace helixnav::association
