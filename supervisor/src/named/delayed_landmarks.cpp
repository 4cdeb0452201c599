// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/delayed_landmarks.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "named/sensor_places.hpp"
#include "named/waiting_fit.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

void check_delayed(const std::vector<DelayedSighting>& sightings) {
  std::set<std::int64_t> identities;
  for (const DelayedSighting& sighting : sightings) {
    core::check_observation(sighting.observation);
    if (core::dimension(sighting.observation.kind) != 1) {
      throw core::PreconditionError("sight: an observation of two rows needs no delay");
    }
    if (!identities.insert(sighting.identity).second) throw core::PreconditionError("sight: an identity occurs twice");
  }
}

}  // namespace

std::vector<std::optional<LandmarkId>> DelayedLandmarks::sight(cekf::CompressedEkf& filter,
                                                               const std::vector<DelayedSighting>& sightings,
                                                               const core::Pose2& T_robot_sensor) {
  check_delayed(sightings);
  std::vector<std::optional<LandmarkId>> entered(sightings.size());
  const bool any_is_due = std::any_of(sightings.begin(), sightings.end(), [&](const DelayedSighting& sighting) {
    return is_due(filter, sighting.identity, T_robot_sensor, options_.spacing_m);
  });
  if (!any_is_due) return entered;
  keep(filter, sightings, T_robot_sensor);
  thin_out();
  const std::map<std::int64_t, LandmarkId> names = enter(filter, sightings);
  remove_unused_places(filter);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const auto name = names.find(sightings[i].identity);
    if (name != names.end()) entered[i] = name->second;
  }
  return entered;
}

double DelayedLandmarks::distance_m(const cekf::CompressedEkf& filter, const Place& place,
                                    const core::Pose2& T_robot_sensor) const {
  const Eigen::Vector2d sensor_m = core::transform(filter.pose().mean, T_robot_sensor.position_m());
  return (filter.landmark_mean(place.position) - sensor_m).norm();
}

/// Whether the sensor has moved since the last sighting that was kept; before the first one, since the same sensor's
/// last place.
bool DelayedLandmarks::is_due(const cekf::CompressedEkf& filter, std::int64_t identity,
                              const core::Pose2& T_robot_sensor, double spacing_m) const {
  const auto known = waiting_.find(identity);
  if (known != waiting_.end()) {
    const Place& last = places_.at(known->second.seen.rbegin()->first);
    return distance_m(filter, last, T_robot_sensor) >= spacing_m;
  }
  const auto last = std::find_if(places_.rbegin(), places_.rend(), [&](const auto& place) {
    return place.second.T_robot_sensor.vector() == T_robot_sensor.vector();
  });
  return last == places_.rend() || distance_m(filter, last->second, T_robot_sensor) >= spacing_m;
}

/// A new place, and all sightings from it that are not too close to the last ones, so that landmarks share places.
void DelayedLandmarks::keep(cekf::CompressedEkf& filter, const std::vector<DelayedSighting>& sightings,
                            const core::Pose2& T_robot_sensor) {
  std::vector<const DelayedSighting*> kept;
  bool any_bearing = false;
  for (const DelayedSighting& sighting : sightings) {
    const bool is_new = waiting_.count(sighting.identity) == 0;
    if (!is_new && !is_due(filter, sighting.identity, T_robot_sensor, 0.5 * options_.spacing_m)) continue;
    kept.push_back(&sighting);
    any_bearing |= sighting.observation.kind == core::ObservationKind::bearing;
  }
  Place place;
  place.T_robot_sensor = T_robot_sensor;
  if (!places_.empty()) {
    const Place& last = places_.rbegin()->second;
    place.along_m = last.along_m + distance_m(filter, last, T_robot_sensor);
  }
  const SensorClone clone =
      clone_sensor(filter, T_robot_sensor, any_bearing ? options_.ahead_m : 0.0, options_.clone_sigma_m);
  place.position = clone.position;
  place.ahead = clone.ahead;
  for (const DelayedSighting* sighting : kept) {
    waiting_[sighting->identity].seen.emplace(next_place_, sighting->observation);
  }
  places_.emplace(next_place_++, place);
}

/// Of numbered places, neither the first nor the last, the one whose neighbours are closest together for how long ago it
/// was: dense where the vehicle is, sparse where it was.
template <class ByNumber>
DelayedLandmarks::PlaceNumber DelayedLandmarks::least_needed(const ByNumber& by_number) const {
  const double now_m = places_.rbegin()->second.along_m;
  double least = std::numeric_limits<double>::infinity();
  PlaceNumber number = by_number.begin()->first;
  for (auto place = std::next(by_number.begin()); std::next(place) != by_number.end(); ++place) {
    const double gap_m = places_.at(std::next(place)->first).along_m - places_.at(std::prev(place)->first).along_m;
    const double need = gap_m / (now_m - places_.at(place->first).along_m + options_.spacing_m);
    if (need >= least) continue;
    least = need;
    number = place->first;
  }
  return number;
}

void DelayedLandmarks::thin_out() {
  const auto window = static_cast<std::size_t>(options_.window);
  for (auto& [identity, waiting] : waiting_) {
    if (waiting.seen.size() > window) waiting.seen.erase(least_needed(waiting.seen));
  }
  constexpr std::size_t groups = 4;  // of landmarks that are not seen together
  if (places_.size() > groups * window) forget_place(least_needed(places_));
}

void DelayedLandmarks::forget_place(PlaceNumber number) {
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    waiting->second.seen.erase(number);
    waiting = waiting->second.seen.empty() ? waiting_.erase(waiting) : std::next(waiting);
  }
}

void DelayedLandmarks::remove_unused_places(cekf::CompressedEkf& filter) {
  std::set<PlaceNumber> used;
  for (const auto& [identity, waiting] : waiting_) {
    for (const auto& [number, observation] : waiting.seen) used.insert(number);
  }
  for (auto place = places_.begin(); place != places_.end();) {
    if (used.count(place->first) != 0) {
      ++place;
      continue;
    }
    remove_clone(filter, {place->second.position, place->second.ahead});
    place = places_.erase(place);
  }
}

/// The places that the sightings' landmarks were seen from.
DelayedLandmarks::PlacesInUse DelayedLandmarks::places_in_use(const std::vector<DelayedSighting>& sightings) const {
  PlacesInUse used;
  for (const DelayedSighting& sighting : sightings) {
    const auto waiting = waiting_.find(sighting.identity);
    if (waiting == waiting_.end()) continue;
    for (const auto& [number, observation] : waiting->second.seen) used.emplace(number, 0);
  }
  Eigen::Index first = 0;
  for (auto& [number, coordinate] : used) coordinate = std::exchange(first, first + 3);
  return used;
}

std::map<std::int64_t, LandmarkId> DelayedLandmarks::enter(cekf::CompressedEkf& filter,
                                                           const std::vector<DelayedSighting>& sightings) {
  const PlacesInUse used = places_in_use(sightings);
  std::vector<SensorClone> clones;
  for (const auto& [number, first] : used) {
    clones.push_back({places_.at(number).position, places_.at(number).ahead});
  }
  const SensorPlaces places = sensor_places(filter, clones);
  const DeterminedLandmarks found = determined(with_guesses(sightings, used, places), places.covariance, options_);
  for (const std::int64_t identity : found.contradicted) waiting_.at(identity).guess_m.reset();
  std::map<std::int64_t, LandmarkId> names;
  if (found.landmarks.empty()) return names;
  filter.update(rows_about_places(found, places));
  const SensorPlaces now = sensor_places(filter, clones);
  for (std::size_t j = 0; j < found.landmarks.size(); ++j) {
    std::vector<FitRow> rows = found.landmarks[j].rows;
    for (FitRow& row : rows) {
      row.sensor = now.T_robot_sensor[static_cast<std::size_t>(row.first / 3)];
      row.variance *= found.noise_scale;
    }
    const std::int64_t identity = found.landmarks[j].identity;
    waiting_.erase(identity);  // its sightings have been used
    if (!found.landmarks[j].enters) continue;
    const auto point = derived_from_places(rows, found.fit.points_m[j], now, options_.same_m);
    if (point) names.emplace(identity, filter.augment(*point));
  }
  return names;
}

/// The longer a landmark waits, the less the next sighting tells, and the search from everywhere is dear.
bool DelayedLandmarks::is_worth_a_guess(const Waiting& waiting) const {
  const double first_m = places_.at(waiting.seen.begin()->first).along_m;
  const double last_m = places_.at(waiting.seen.rbegin()->first).along_m;
  return last_m - waiting.guessed_at_m >= (last_m - first_m) / options_.window;
}

std::vector<WaitingLandmark> DelayedLandmarks::with_guesses(const std::vector<DelayedSighting>& sightings,
                                                            const PlacesInUse& used, const SensorPlaces& places) {
  std::vector<WaitingLandmark> guessed;
  const core::Pose2& pose = places.joint.pose;
  for (const DelayedSighting& sighting : sightings) {
    const auto known = waiting_.find(sighting.identity);
    if (known == waiting_.end()) continue;
    Waiting& waiting = known->second;
    WaitingLandmark landmark{sighting.identity, {}, {}};
    for (const auto& [number, observation] : waiting.seen) {
      const Eigen::Index first = used.at(number);
      landmark.rows.push_back({observation.kind, observation.z[0], observation.R(0, 0),
                               places.T_robot_sensor[static_cast<std::size_t>(first / 3)], first});
    }
    if (waiting.guess_m) {
      landmark.guess_m = core::transform(core::inverse(pose), *waiting.guess_m);
    } else {
      if (!is_worth_a_guess(waiting)) continue;
      waiting.guessed_at_m = places_.rbegin()->second.along_m;
      const OwnGuess own = guess_alone(landmark.rows, places.covariance, options_);
      if (!own.point_m) continue;
      if (own.wrong_row) {
        const auto row = static_cast<std::ptrdiff_t>(*own.wrong_row);
        landmark.rows.erase(landmark.rows.begin() + row);
        waiting.seen.erase(std::next(waiting.seen.begin(), row));
      }
      landmark.guess_m = own.point_m;
      waiting.guess_m = core::transform(pose, *own.point_m);
    }
    guessed.push_back(std::move(landmark));
  }
  return guessed;
}

int DelayedLandmarks::clones() const {
  int count = 0;
  for (const auto& [number, place] : places_) count += place.ahead == core::no_landmark ? 1 : 2;
  return count;
}

}  // namespace helixnav::supervisor
