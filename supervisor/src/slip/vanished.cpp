// SPDX-License-Identifier: BSD-3-Clause
#include "slip/vanished.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "association/association_report.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using core::Outcome;

constexpr double most_share = 0.9;     ///< what hides one landmark may hide its neighbours
constexpr double least_chance = 0.05;  ///< of a match after a slip: landmarks stand in groups
constexpr double keep = 1.0 - 1.0 / 200.0;
constexpr double scans_a_slip = 400.0;  ///< before anything is known
constexpr std::size_t least_missing = 2;
constexpr std::size_t least_unknown = 3;
constexpr std::size_t least_lasting = 2;
constexpr int decided_after = 3;  ///< scans
constexpr std::size_t most_sensors = 8;

bool holds(const std::vector<LandmarkId>& ids, LandmarkId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::size_t in_both(const std::vector<LandmarkId>& some, const std::vector<LandmarkId>& others) {
  return static_cast<std::size_t>(std::count_if(some.begin(), some.end(), [&others](LandmarkId id) {
    return std::find(others.begin(), others.end(), id) != others.end();
  }));
}

bool is_nearly_all(std::size_t missing, std::size_t seen) { return missing >= least_missing && missing >= 3 * seen; }

std::vector<LandmarkId> seen_by(const std::vector<core::AssociationReport>& fate) {
  std::vector<LandmarkId> seen = landmarks_with(Outcome::matched, fate);
  for (const LandmarkId id : landmarks_with(Outcome::augmented, fate)) seen.push_back(id);
  return seen;
}

/// Of those in view, that the last scan saw.
void count_seen_again(const std::vector<LandmarkId>& matched, const std::vector<LandmarkId>& in_view,
                      const std::vector<LandmarkId>& last, ShareSeen& share) {
  share.forget_slowly();
  for (const LandmarkId id : last) {
    if (holds(in_view, id)) share.count(holds(matched, id));
  }
}

/// Those seen by a single look may be clutter, which does not come again.
void keep_well_known(const association::LandmarkLife& existence, std::vector<LandmarkId>& ids) {
  constexpr int well_known = 2;  // looks
  const auto is_not = [&](LandmarkId id) { return !existence.contains(id) || existence.record(id).hits < well_known; };
  ids.erase(std::remove_if(ids.begin(), ids.end(), is_not), ids.end());
}

/// ln P(so many are back | elsewhere) / P(the same | any number was as likely).
double nats_of_return(std::size_t back, std::size_t of, double by_chance) {
  const auto n = static_cast<double>(of);
  const auto k = static_cast<double>(back);
  const double ways = std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
  return ways + k * std::log(by_chance) + (n - k) * std::log(1.0 - by_chance) + std::log(n + 1.0);
}

}  // namespace

void ShareSeen::forget_slowly() {
  seen_ *= keep;
  looks_ *= keep;
}

void ShareSeen::count(bool is_seen) {
  seen_ += is_seen ? 1.0 : 0.0;
  looks_ += 1.0;
}

double ShareSeen::share() const {
  return std::min(most_share, (seen_ + assumed_ * assumed_looks) / (looks_ + assumed_looks));
}

double ShareSeen::nats(bool is_seen, double by_chance) const {
  return is_seen ? std::log(by_chance / share()) : std::log((1.0 - by_chance) / (1.0 - share()));
}

/// What became of some landmarks in a scan.
struct SeenAgain::Again {
  std::vector<LandmarkId> missing;
  std::vector<LandmarkId> seen;
  double nats = 0.0;  ///< by which "elsewhere" explains it better
  double by_chance = least_chance;
};

std::size_t SeenAgain::sensor_of(const core::Scan& scan) {
  const core::FieldOfView& view = scan.field_of_view;
  const auto is_it = [&](const BySensor& one) {
    return one.T_robot_sensor.vector() == scan.T_robot_sensor.vector() && one.min_bearing_rad == view.min_bearing_rad &&
           one.max_bearing_rad == view.max_bearing_rad;
  };
  const auto found = std::find_if(sensors_.begin(), sensors_.end(), is_it);
  if (found != sensors_.end()) return static_cast<std::size_t>(found - sensors_.begin());
  if (sensors_.size() == most_sensors) sensors_.pop_back();
  sensors_.push_back({scan.T_robot_sensor, view.min_bearing_rad, view.max_bearing_rad});
  return sensors_.size() - 1;
}

SeenAgain::Again SeenAgain::again(const BySensor& by, const std::vector<LandmarkId>& ids,
                                  const std::vector<core::AssociationReport>& fate, const InView& in_view,
                                  const Chance& chance) const {
  const std::vector<LandmarkId> matched = landmarks_with(Outcome::matched, fate);
  Again again;
  for (const LandmarkId id : ids) {
    const bool is_in_view = holds(in_view.surely, id) || holds(in_view.perhaps, id);
    if (holds(matched, id)) {
      again.seen.push_back(id);
    } else if (is_in_view) {
      again.missing.push_back(id);
    }
  }
  const bool is_in_question = suspicion_ || is_nearly_all(again.missing.size(), again.seen.size());
  if (is_in_question && !again.seen.empty()) {
    std::vector<LandmarkId> both = again.missing;
    both.insert(both.end(), again.seen.begin(), again.seen.end());
    again.by_chance = std::clamp(chance(both), least_chance, most_share);
  }
  for (const bool is_seen : {false, true}) {
    const std::vector<LandmarkId>& those = is_seen ? again.seen : again.missing;
    const auto surely = static_cast<double>(in_both(those, in_view.surely));
    const double perhaps = static_cast<double>(those.size()) - surely;
    again.nats +=
        surely * by.surely.nats(is_seen, again.by_chance) + perhaps * by.perhaps.nats(is_seen, again.by_chance);
  }
  return again;
}

Vanished SeenAgain::weigh(const BySensor& by, const std::vector<core::AssociationReport>& fate, const InView& in_view,
                          const association::LandmarkLife& existence, double extraneous_per_scan,
                          const Chance& chance) const {
  Again again = this->again(by, by.last, fate, in_view, chance);
  Vanished vanished;
  vanished.missing = std::move(again.missing);
  vanished.seen = static_cast<int>(again.seen.size());
  vanished.unknown = landmarks_with(Outcome::augmented, fate);
  const double new_per_scan = existence.born_per_scan(extraneous_per_scan);
  const double known_per_scan = std::max(existence.seen_per_scan(), new_per_scan);
  const auto unknown = static_cast<double>(vanished.unknown.size());
  vanished.nats = again.nats + unknown * std::log(known_per_scan / new_per_scan) + new_per_scan - known_per_scan;
  return vanished;
}

std::vector<LandmarkId> SeenAgain::watched(std::size_t sensor) const {
  std::vector<LandmarkId> ids = sensors_[sensor].last;
  if (!suspicion_) return ids;
  ids.insert(ids.end(), suspicion_->missing.begin(), suspicion_->missing.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

/// What hid the landmarks may still hide any share of them, if the vehicle is where odometry puts it; elsewhere, chance brings them back.
void SeenAgain::judge(std::size_t sensor, const std::vector<core::AssociationReport>& fate, const InView& in_view,
                      const Chance& chance) {
  const Again since = again(sensors_[sensor], suspicion_->missing, fate, in_view, chance);
  const std::size_t of = since.missing.size() + since.seen.size();
  if (of == 0 && sensor != suspicion_->sensor) return;  // it looks elsewhere
  suspicion_->looks += sensor == suspicion_->sensor ? 1 : 0;
  const double nats = nats_of_return(since.seen.size(), of, since.by_chance);
  const bool is_there = in_both(suspicion_->unknown, landmarks_with(Outcome::matched, fate)) >= least_lasting;
  if (is_there && of > 0 && nats > 0.0) {
    is_confirmed_ = true;
  } else if (nats < 0.0 || suspicion_->looks >= decided_after) {
    suspicion_.reset();
  }
}

void SeenAgain::see(std::int64_t step, std::size_t sensor, const std::vector<core::AssociationReport>& fate,
                    const InView& in_view, const association::LandmarkLife& existence, double extraneous_per_scan,
                    int slips, const Chance& chance) {
  if (std::exchange(is_confirmed_, false)) suspicion_.reset();  // nothing came of it: too late to go back
  BySensor& by = sensors_[sensor];
  keep_well_known(existence, by.last);
  if (suspicion_) {
    judge(sensor, fate, in_view, chance);
  } else {
    const double needed = std::log((static_cast<double>(step) + scans_a_slip) / (static_cast<double>(slips) + 1.0));
    Vanished vanished = weigh(by, fate, in_view, existence, extraneous_per_scan, chance);
    vanished.step = step;
    vanished.sensor = sensor;
    const auto seen = static_cast<std::size_t>(vanished.seen);
    if (is_nearly_all(vanished.missing.size(), seen) && vanished.unknown.size() >= least_unknown &&
        vanished.nats > needed)
      suspicion_ = std::move(vanished);
  }
  const std::vector<LandmarkId> matched = landmarks_with(Outcome::matched, fate);
  count_seen_again(matched, in_view.surely, by.last, by.surely);
  count_seen_again(matched, in_view.perhaps, by.last, by.perhaps);
  by.last = seen_by(fate);
}

void SeenAgain::start_from(std::size_t sensor, const std::vector<core::AssociationReport>& fate) {
  forget();
  sensors_[sensor].last = seen_by(fate);
}

void SeenAgain::leave_out(const std::vector<LandmarkId>& ids) {
  const auto is_left_out = [&ids](LandmarkId id) { return std::binary_search(ids.begin(), ids.end(), id); };
  suspicion_.reset();
  is_confirmed_ = false;
  for (BySensor& by : sensors_)
    by.last.erase(std::remove_if(by.last.begin(), by.last.end(), is_left_out), by.last.end());
}

void SeenAgain::forget() {
  suspicion_.reset();
  is_confirmed_ = false;
  for (BySensor& by : sensors_) by.last.clear();
}

}  // namespace helixnav::supervisor
