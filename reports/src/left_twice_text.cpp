// SPDX-License-Identifier: BSD-3-Clause
#include "left_twice_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/reports/decision_sentence.hpp"

namespace helixnav::reports {
namespace {

using core::LandmarkId;

/// Landmarks by x, so that the nearest is found among few.
class ByX {
 public:
  void add(const core::MapLandmark& landmark) { points_.emplace_back(landmark.point.mean_m.x(), &landmark); }
  void sort() { std::sort(points_.begin(), points_.end()); }

  /// Median distance to the nearest other one; 0 for a single one.
  double spacing_m() const {
    std::vector<double> nearest_m;
    for (const auto& [x_m, landmark] : points_) {
      double distance_m = 0.0;
      if (nearest_to(*landmark, distance_m) != nullptr) nearest_m.push_back(distance_m);
    }
    if (nearest_m.empty()) return 0.0;
    const auto middle = nearest_m.begin() + static_cast<std::ptrdiff_t>(nearest_m.size() / 2);
    std::nth_element(nearest_m.begin(), middle, nearest_m.end());
    return *middle;
  }

  /// Other than itself; null if there is none.
  const core::MapLandmark* nearest_to(const core::MapLandmark& landmark, double& distance_m) const {
    distance_m = std::numeric_limits<double>::infinity();
    const core::MapLandmark* nearest = nullptr;
    const double x_m = landmark.point.mean_m.x();
    const auto take = [&](const core::MapLandmark& other) {
      const double away_m = (other.point.mean_m - landmark.point.mean_m).norm();
      if (other.id == landmark.id || away_m >= distance_m) return;
      distance_m = away_m;
      nearest = &other;
    };
    const auto middle = std::lower_bound(points_.begin(), points_.end(), std::make_pair(x_m, &landmark));
    for (auto up = middle; up != points_.end() && up->first - x_m < distance_m; ++up) take(*up->second);
    for (auto down = middle; down != points_.begin() && x_m - std::prev(down)->first < distance_m; --down) {
      take(*std::prev(down)->second);
    }
    return nearest;
  }

 private:
  std::vector<std::pair<double, const core::MapLandmark*>> points_;
};

bool is_closing(const core::Decision& decision) {
  const auto* closure = std::get_if<core::ClosureDecision>(&decision);
  return closure != nullptr && closure->accepted;
}

std::set<LandmarkId> begun_in_closed_searches(const runs::Run& run) {
  std::set<LandmarkId> closed, open;
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) {
      const bool is_begun = step.mode == core::Mode::searching && a.outcome == core::Outcome::augmented;
      if (is_begun) open.insert(a.landmark);
    }
    if (std::any_of(step.decisions.begin(), step.decisions.end(), is_closing)) closed.insert(open.begin(), open.end());
    if (step.mode == core::Mode::mapping) open.clear();
  }
  return closed;
}

struct Older {
  LandmarkId id = core::no_landmark;
  double distance_m = 0.0;
};

/// [newer landmark] an older one, nearer than `near_m`.
using Beside = std::map<LandmarkId, Older>;

Beside beside_older(const std::vector<const core::MapLandmark*>& fresh, const ByX& known, double near_m) {
  Beside beside;
  for (const core::MapLandmark* landmark : fresh) {
    double distance_m = 0.0;
    const core::MapLandmark* other = known.nearest_to(*landmark, distance_m);
    if (other == nullptr || distance_m > near_m || other->id > landmark->id) continue;
    beside[landmark->id] = {other->id, distance_m};
  }
  return beside;
}

/// Those that some scan saw both of are two.
void drop_seen_together(const runs::Run& run, Beside& beside) {
  for (const core::StepReport& step : run.steps) {
    std::set<LandmarkId> seen;
    for (const core::AssociationReport& a : step.associations) {
      if (a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented) seen.insert(a.landmark);
    }
    for (const LandmarkId id : seen) {
      const auto pair = beside.find(id);
      if (pair != beside.end() && seen.count(pair->second.id) > 0) beside.erase(pair);
    }
  }
}

std::string text_of(const Beside& beside) {
  double farthest_m = 0.0;
  for (const auto& [id, older] : beside) farthest_m = std::max(farthest_m, older.distance_m);
  return counted(static_cast<double>(beside.size()), "landmark") + " mapped before a loop was closed stand within " +
         short_number(farthest_m) +
         " m of older ones and may be on the map twice: what a closing does not surely show to be one stays two. They "
         "may be merged when the vehicle drives there again";
}

}  // namespace

std::string left_twice_text(const runs::Run& run) {
  const std::set<LandmarkId> begun = begun_in_closed_searches(run);
  ByX known;
  std::vector<const core::MapLandmark*> fresh;
  for (const core::MapLandmark& landmark : run.map) {
    if (landmark.state != core::LandmarkState::mature) continue;
    if (begun.count(landmark.id) > 0) {
      fresh.push_back(&landmark);
    } else {
      known.add(landmark);
    }
  }
  if (fresh.empty()) return {};
  known.sort();
  const double spacing_m = known.spacing_m();
  constexpr double least = 3.0, times_chance = 5.0;
  for (const double share : {0.25, 0.1}) {
    Beside beside = beside_older(fresh, known, share * spacing_m);
    // Of landmarks at random, with a median distance of the nearest of s: 1 − 2^(−share²) of them within share·s.
    const double by_chance = (1.0 - std::exp2(-share * share)) * static_cast<double>(fresh.size());
    const auto is_enough = [&] {
      return static_cast<double>(beside.size()) >= std::max(least, times_chance * by_chance);
    };
    if (!is_enough()) continue;
    drop_seen_together(run, beside);
    if (is_enough()) return text_of(beside);
  }
  return {};
}

}  // namespace helixnav::reports
