// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/landmark_life.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "helixnav/core/errors.hpp"

namespace helixnav::association {
namespace {

using core::LandmarkId;
using core::LandmarkState;

bool before(const LandmarkRecord& record, LandmarkId id) { return record.id < id; }

int most_unseen_at_rest(double detection_probability) {
  constexpr double chance = 1e-3;
  return static_cast<int>(std::ceil(std::log(chance) / std::log1p(-0.5 * detection_probability)));
}

bool is_listed(const std::vector<LandmarkId>& ids, LandmarkId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

bool is_listed(const std::vector<UnusedSighting>& unused, LandmarkId id) {
  return std::any_of(unused.begin(), unused.end(), [id](const UnusedSighting& one) { return one.id == id; });
}

}  // namespace

LandmarkLife::LandmarkLife(const LifeOptions& options)
    : options_(options),
      hit_nats_(std::log(options.detection_probability / options.false_hit_probability)),
      miss_nats_(std::log((1.0 - options.detection_probability) / (1.0 - options.false_hit_probability))) {
  const bool ok = options.false_hit_probability > 0.0 &&
                  options.false_hit_probability < options.detection_probability &&
                  options.detection_probability < 1.0 && options.tentative_death_log_odds < options.birth_log_odds &&
                  options.mature_death_log_odds < options.birth_log_odds &&
                  options.birth_log_odds < options.mature_log_odds && options.mature_log_odds <= options.max_log_odds &&
                  options.mature_looks >= 1 && options.look_distance_m >= 0.0 && options.tentative_patience_m > 0.0;
  if (!ok) {
    throw core::PreconditionError(
        "landmark life: 0 < false_hit_probability < detection_probability < 1, death log-odds < birth < mature <= max, "
        "mature_looks >= 1, look_distance_m >= 0 and tentative_patience_m > 0 expected");
  }
  most_unseen_at_rest_ = most_unseen_at_rest(options.detection_probability);
}

void LandmarkLife::set_lengths(double look_distance_m, double tentative_patience_m) {
  if (!(look_distance_m >= 0.0 && tentative_patience_m > 0.0)) {
    throw core::PreconditionError("landmark life: look_distance_m >= 0 and tentative_patience_m > 0 expected");
  }
  options_.look_distance_m = look_distance_m;
  options_.tentative_patience_m = tentative_patience_m;
}

void LandmarkLife::pass(const std::vector<LandmarkId>& unseen_at_rim) {
  for (const LandmarkId id : unseen_at_rim) record(id);
  for (const LandmarkId id : unseen_at_rim) {
    LandmarkRecord& one = *find(id);
    const double last_m = std::max(one.last_seen_path_m, one.last_passed_path_m);
    if (one.state != LandmarkState::mature || path_m_ - last_m < options_.tentative_patience_m) continue;
    ++one.misses;
    one.last_passed_path_m = path_m_;
    one.log_odds += miss_nats_;
  }
}

bool LandmarkLife::note_if_blinded(std::size_t observations, std::size_t expected) {
  constexpr std::size_t many = 3;
  const bool sees_nothing = observations == 0 && expected >= many;
  return std::exchange(saw_nothing_, sees_nothing) && sees_nothing;
}

LifeChanges LandmarkLife::observe(const Eigen::Vector2d& sensor_m, const std::vector<LandmarkId>& seen,
                                  const std::vector<LandmarkId>& born, const std::vector<LandmarkId>& expected,
                                  const std::vector<double>& seen_nats, const std::vector<UnusedSighting>& unused) {
  check_scan(seen, born, expected, unused);
  if (!seen_nats.empty() && seen_nats.size() != seen.size())
    throw core::PreconditionError("landmark life: evidence of as many landmarks as were seen expected");
  ++scans_;
  born_ += born.size();
  seen_ += seen.size();
  for (std::size_t i = 0; i < seen.size(); ++i) hit(*find(seen[i]), sensor_m, seen_nats.empty() ? 0.0 : seen_nats[i]);
  for (const UnusedSighting& one : unused) count_unused(*find(one.id), sensor_m, one.nats);
  for (const LandmarkId id : expected) {
    if (!is_listed(seen, id) && !is_listed(born, id) && !is_listed(unused, id)) miss(*find(id), sensor_m);
  }
  for (const LandmarkId id : born) {
    LandmarkRecord record;
    record.id = id;
    record.log_odds = options_.birth_log_odds;
    record.observations = record.hits = 1;
    record.unseen_at_rest = -1;
    record.last_hit_at_m = record.last_miss_at_m = sensor_m;
    record.born_path_m = record.last_seen_path_m = path_m_;
    records_.insert(std::lower_bound(records_.begin(), records_.end(), id, before), record);
  }
  LifeChanges changes;
  for (LandmarkRecord& record : records_) {
    count_unseen_at_rest(record, sensor_m);
    if (record.state == LandmarkState::tentative && record.hits >= options_.mature_looks &&
        record.log_odds >= options_.mature_log_odds) {
      record.state = LandmarkState::mature;
      ++matured_;
      changes.matured.push_back(record.id);
    } else if (is_dying(record)) {
      died_tentative_ += record.state == LandmarkState::tentative ? 1 : 0;
      changes.died.push_back(record.id);
    }
  }
  for (const LandmarkId id : changes.died) remove(id);
  return changes;
}

void LandmarkLife::check_scan(const std::vector<LandmarkId>& seen, const std::vector<LandmarkId>& born,
                              const std::vector<LandmarkId>& expected,
                              const std::vector<UnusedSighting>& unused) const {
  const auto require = [](bool ok, LandmarkId id, const char* what) {
    if (!ok) throw core::PreconditionError("landmark life: landmark " + std::to_string(id) + what);
  };
  for (const LandmarkId id : seen) require(contains(id), id, " was seen but never born");
  for (const UnusedSighting& one : unused) require(contains(one.id), one.id, " was seen but never born");
  for (const LandmarkId id : expected) require(contains(id) || is_listed(born, id), id, " is expected but unknown");
  for (const LandmarkId id : born) {
    require(!contains(id), id, " is born twice");
    require(std::count(born.begin(), born.end(), id) == 1, id, " is born twice");
  }
}

void LandmarkLife::hit(LandmarkRecord& record, const Eigen::Vector2d& sensor_m, double appearance_nats) {
  ++record.observations;
  if (!note_look(record, sensor_m)) return;
  ++record.hits;
  record.log_odds = std::min(options_.max_log_odds, record.log_odds + hit_nats_ + appearance_nats);
}

void LandmarkLife::count_unused(LandmarkRecord& record, const Eigen::Vector2d& sensor_m, double nats) const {
  if (note_look(record, sensor_m))
    record.log_odds = std::min(options_.max_log_odds, record.log_odds + std::min(hit_nats_, nats));
}

/// Records that it was seen; false if a look from about here has already been counted.
bool LandmarkLife::note_look(LandmarkRecord& record, const Eigen::Vector2d& sensor_m) const {
  record.unseen_at_rest = -1;  // this scan is counted, too
  record.last_seen_path_m = path_m_;
  if ((sensor_m - record.last_hit_at_m).norm() < options_.look_distance_m) return false;
  record.last_hit_at_m = sensor_m;
  return true;
}

void LandmarkLife::miss(LandmarkRecord& record, const Eigen::Vector2d& sensor_m) {
  if ((sensor_m - record.last_miss_at_m).norm() < options_.look_distance_m) return;
  ++record.misses;
  record.last_miss_at_m = sensor_m;
  record.log_odds += miss_nats_;
}

void LandmarkLife::count_unseen_at_rest(LandmarkRecord& record, const Eigen::Vector2d& sensor_m) const {
  const bool is_at_rest = (sensor_m - record.last_hit_at_m).norm() < options_.look_distance_m;
  if (is_at_rest || record.unseen_at_rest < 0) ++record.unseen_at_rest;
}

bool LandmarkLife::is_dying(const LandmarkRecord& record) const {
  if (record.state == LandmarkState::mature) {
    return options_.mature_may_die && record.log_odds <= options_.mature_death_log_odds;
  }
  return record.log_odds <= options_.tentative_death_log_odds ||
         (record.hits == 1 && record.unseen_at_rest >= most_unseen_at_rest_) ||
         path_m_ - record.last_seen_path_m > options_.tentative_patience_m;
}

void LandmarkLife::adopt(const LandmarkRecord& record) {
  if (contains(record.id) || record.id < 0) {
    throw core::PreconditionError("landmark life: landmark " + std::to_string(record.id) + " is recorded, or no name");
  }
  records_.insert(std::lower_bound(records_.begin(), records_.end(), record.id, before), record);
}

void LandmarkLife::change_frame(const core::Pose2& T_new_old) {
  for (LandmarkRecord& record : records_) {
    record.last_hit_at_m = core::transform(T_new_old, record.last_hit_at_m);
    record.last_miss_at_m = core::transform(T_new_old, record.last_miss_at_m);
  }
}

void LandmarkLife::remove(LandmarkId id) {
  LandmarkRecord* record = find(id);
  if (record == nullptr) throw core::PreconditionError("landmark life: no landmark " + std::to_string(id));
  records_.erase(records_.begin() + (record - records_.data()));
  appearance_.remove(id);
}

void LandmarkLife::merge(LandmarkId kept, LandmarkId removed) {
  if (kept == removed)
    throw core::PreconditionError("landmark life: landmark " + std::to_string(kept) + " with itself");
  record(kept);
  const LandmarkRecord gone = record(removed);
  appearance_.merge(kept, removed);
  remove(removed);
  LandmarkRecord& one = *find(kept);
  one.observations += gone.observations;
  one.hits += gone.hits;
  one.misses += gone.misses;
  one.log_odds = std::min(options_.max_log_odds, one.log_odds + std::max(0.0, gone.log_odds));
  if (gone.state == LandmarkState::mature) one.state = LandmarkState::mature;
  one.born_path_m = std::min(one.born_path_m, gone.born_path_m);
  if (gone.last_seen_path_m > one.last_seen_path_m) {
    one.last_seen_path_m = gone.last_seen_path_m;
    one.last_hit_at_m = gone.last_hit_at_m;
    one.last_miss_at_m = gone.last_miss_at_m;
  }
}

LandmarkRecord* LandmarkLife::find(LandmarkId id) {
  const auto at = std::lower_bound(records_.begin(), records_.end(), id, before);
  return at != records_.end() && at->id == id ? &*at : nullptr;
}

const LandmarkRecord* LandmarkLife::find(LandmarkId id) const {
  const auto at = std::lower_bound(records_.begin(), records_.end(), id, before);
  return at != records_.end() && at->id == id ? &*at : nullptr;
}

bool LandmarkLife::contains(LandmarkId id) const { return find(id) != nullptr; }

const LandmarkRecord& LandmarkLife::record(LandmarkId id) const {
  const LandmarkRecord* record = find(id);
  if (record == nullptr) throw core::PreconditionError("landmark life: no landmark " + std::to_string(id));
  return *record;
}

double LandmarkLife::odds(LandmarkId id) const {
  const double of_begun = static_cast<double>(matured_ + 1) / static_cast<double>(died_tentative_ + 1);
  return of_begun * std::exp(record(id).log_odds - options_.birth_log_odds);
}

LandmarkState LandmarkLife::state(LandmarkId id) const {
  const LandmarkRecord* record = find(id);
  return record == nullptr ? LandmarkState::dead : record->state;
}

}  // namespace helixnav::association
