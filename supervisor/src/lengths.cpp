// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/lengths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "association/view_area.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::supervisor {
namespace {

using Options = NavigatorOptions;

/// A length as a fraction of the reach, in whole numbers, so that a reach of 30 m gives the round values measured
/// there.
struct Row {
  std::string_view name;
  double numerator, denominator;
  double& (*of)(Options&);
  int power = 1;  ///< of the reach: 1 length, −2 density

  double at(double reach_m) const {
    return power == 1 ? reach_m * numerator / denominator : numerator / (denominator * reach_m * reach_m);
  }
};

constexpr std::array rows{
    // Regions of the filter; a switch costs O(N²) of all landmarks, an active landmark O(N_active) a scan.
    Row{"filter.cell_side_m", 2, 3, [](Options& o) -> double& { return o.filter.cell_side_m; }},
    Row{"filter.hysteresis_m", 2, 3, [](Options& o) -> double& { return o.filter.hysteresis_m; }},

    // Existence of landmarks, and what was looked at.
    Row{"landmarks.look_distance_m", 1, 120, [](Options& o) -> double& { return o.life.look_distance_m; }},
    Row{"landmarks.tentative_patience_m", 1, 1, [](Options& o) -> double& { return o.life.tentative_patience_m; }},
    Row{"landmarks.view_margin_m", 1, 15, [](Options& o) -> double& { return o.view_margin_m; }},
    Row{"search.coverage_spacing_m", 2, 15, [](Options& o) -> double& { return o.search.coverage_spacing_m; }},

    // When a search begins, goes on and ends.
    Row{"search.old_after_m", 2, 1,  // of a sensor that looks all around in two views, see views_around
        [](Options& o) -> double& { return o.search.old_after_m; }},
    Row{"search.confirmation_m", 1, 6, [](Options& o) -> double& { return o.search.confirmation_m; }},
    Row{"search.look_distance_m", 1, 30, [](Options& o) -> double& { return o.search.look_distance_m; }},
    Row{"search.reach_m", 11, 3, [](Options& o) -> double& { return o.search.reach_m; }},
    Row{"search.rest_m", 3, 10, [](Options& o) -> double& { return o.search.rest_m; }},
    Row{"search.attempt_m", 7, 2, [](Options& o) -> double& { return o.search.attempt_m; }},
    Row{"search.undecided_m", 11, 1, [](Options& o) -> double& { return o.search.undecided_m; }},
    Row{"search.idle_m", 2, 1, [](Options& o) -> double& { return o.search.idle_m; }},

    // The particle filter.
    Row{"search.relocalizer.bin_m", 1, 60, [](Options& o) -> double& { return o.search.relocalizer.bin_m; }},
    Row{"search.relocalizer.mode_radius_m", 1, 15,
        [](Options& o) -> double& { return o.search.relocalizer.mode_radius.position_m; }},
    Row{"search.gate.sigma_position_m", 1, 60, [](Options& o) -> double& { return o.search.gate.sigma_position_m; }},

    // The constellation test and its rivals.
    Row{"search.branch_seen_within_m", 9, 4, [](Options& o) -> double& { return o.search.branch_seen_within_m; }},
    Row{"search.ask_again_m", 3, 20, [](Options& o) -> double& { return o.search.ask_again_m; }},
    Row{"search.confirm_m", 1, 20, [](Options& o) -> double& { return o.search.confirm_m; }},
    Row{"search.constellation.branch_sigma_m", 1, 200,
        [](Options& o) -> double& { return o.search.constellation.branch_sigma_m; }},
    Row{"search.constellation.most_tolerance_m", 1, 20,
        [](Options& o) -> double& { return o.search.constellation.most_tolerance_m; }},
    Row{"search.rivals.apart_m", 1, 12, [](Options& o) -> double& { return o.search.rivals.apart_m; }},
    Row{"search.rivals.soften_m", 1, 60, [](Options& o) -> double& { return o.search.rivals.soften_m; }},
    Row{"search.rivals.distinct_m", 1, 30, [](Options& o) -> double& { return o.search.rivals.distinct_m; }},
    Row{"search.rivals.branch_sigma_m", 1, 200, [](Options& o) -> double& { return o.search.rivals.branch_sigma_m; }},
    Row{"search.rivals.extraneous_per_m2", 126, 100,
        [](Options& o) -> double& { return o.search.rivals.extraneous_per_m2; }, -2},

    // The closing.
    Row{"search.merge_sigma_m", 1, 1500, [](Options& o) -> double& { return o.search.merge_sigma_m; }},
    Row{"search.duplicate_sigma_m", 1, 3000, [](Options& o) -> double& { return o.search.duplicate_sigma_m; }},
    Row{"search.leftover_least_m", 1, 30, [](Options& o) -> double& { return o.search.leftover_least_m; }},
    Row{"search.leftover_most_m", 1, 12, [](Options& o) -> double& { return o.search.leftover_most_m; }},
    Row{"search.stretch_m", 4, 3, [](Options& o) -> double& { return o.search.stretch_m; }},
    Row{"search.stretch_rim_m", 1, 10, [](Options& o) -> double& { return o.search.stretch_rim_m; }},
    Row{"search.stretch_rigid_m", 7, 300, [](Options& o) -> double& { return o.search.stretch_rigid_m; }},

    // Slips.
    Row{"slip.small_m", 1, 120, [](Options& o) -> double& { return o.slip.small_m; }},
    Row{"slip.middle_m", 7, 300, [](Options& o) -> double& { return o.slip.middle_m; }},
    Row{"slip.large_m", 1, 15, [](Options& o) -> double& { return o.slip.large_m; }},
    Row{"slip.distinct_m", 1, 60, [](Options& o) -> double& { return o.slip.distinct_m; }},

    // Moving things.
    Row{"moving.speed_mps", 1, 6, [](Options& o) -> double& { return o.moving.speed_mps; }},

    // Landmarks seen as a range or a bearing only.
    Row{"delayed.spacing_m", 1, 30, [](Options& o) -> double& { return o.delayed.spacing_m; }},
    Row{"delayed.same_m", 1, 300, [](Options& o) -> double& { return o.delayed.same_m; }},
    Row{"delayed.ahead_m", 1, 3, [](Options& o) -> double& { return o.delayed.ahead_m; }},
    Row{"delayed.clone_sigma_m", 1, 30000, [](Options& o) -> double& { return o.delayed.clone_sigma_m; }},
};

/// Views needed to look all around, at least 2.
double views_around(const core::FieldOfView& view) {
  const double width_rad = view.max_bearing_rad - view.min_bearing_rad;
  return width_rad > 0.0 ? std::max(2.0, std::round(2.0 * core::pi / width_rad)) : 2.0;
}

}  // namespace

NavigatorOptions fit_lengths(NavigatorOptions options, const core::FieldOfView& view) {
  const std::optional<double> reach_m = view.reach();
  if (!reach_m) return options;
  const bool own_old_after = options.search.old_after_m != SearchOptions{}.old_after_m;
  for (const Row& row : rows) {
    double& value = row.of(options);
    if (value == row.at(reference_reach_m)) value = row.at(*reach_m);
  }
  if (!own_old_after) options.search.old_after_m *= 0.5 * views_around(view);
  return options;
}

std::vector<LengthInForce> lengths_in_force(const NavigatorOptions& options) {
  NavigatorOptions copy = options;
  std::vector<LengthInForce> lengths;
  for (const Row& row : rows) lengths.push_back({row.name, row.of(copy)});
  return lengths;
}

void set_length(NavigatorOptions& options, std::string_view name, double value) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == name; });
  if (row == rows.end()) throw core::PreconditionError("set_length: no length is called " + std::string(name));
  row->of(options) = value;
}

SearchOptions with_extraneous_density(SearchOptions search, double born_per_scan, const core::FieldOfView& view) {
  if (!search.learn_extraneous) return search;
  constexpr double least_per_scan = 0.01;  // a count of zero is not an estimate
  search.extraneous_per_scan = std::max(least_per_scan, born_per_scan);
  search.relocalizer.sensor.extraneous_per_scan = search.extraneous_per_scan;
  const double area = view_area_m2(view);
  if (area > 0.0 && std::isfinite(area)) search.rivals.extraneous_per_m2 = search.extraneous_per_scan / area;
  return search;
}

}  // namespace helixnav::supervisor
