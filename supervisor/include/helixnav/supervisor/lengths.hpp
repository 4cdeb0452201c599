// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::supervisor {

/// The sensor reach for which default-constructed options are valid.
constexpr double reference_reach_m = 30.0;

/// A length (or a density) in force in the navigator, as written into manifests.
struct LengthInForce {
  std::string_view name;  ///< section.key, as in a configuration file if it is a key of one
  double value = 0.0;     ///< [m], or [1/m²] for a density
};

/// The options scaled to a sensor with this field of view; unchanged if its reach is unknown. Every length in mapping,
/// search, verification and closing is a multiple of the reach, so that a world, its sensor and its noise at a tenth of
/// their size are navigated in the same way. The multiples are in one table, in lengths.cpp, and nowhere else; a new
/// length is a new row there. A narrower view increases the distance after which a landmark counts as old, because the
/// vehicle also loses sight of it by turning: one reach for every view needed to look all around, at least two. A length
/// that differs from that of reference_reach_m was chosen by the caller and is kept.
/// Test: supervisor/lengths_test.cpp (a world at 1/8 of its size is associated and closed in the same way, down to
/// the last decision).
NavigatorOptions fit_lengths(NavigatorOptions options, const core::FieldOfView& view);

/// All rows of that table with their values in `options`, in table order.
std::vector<LengthInForce> lengths_in_force(const NavigatorOptions& options);

/// Sets one of them by name; PreconditionError for an unknown name.
void set_length(NavigatorOptions& options, std::string_view name, double value);

/// The search options with the density of objects that are not in any map: as given or, with learn_extraneous,
/// `born_per_scan` (LandmarkLife::born_per_scan) divided by the area of `view`.
SearchOptions with_extraneous_density(SearchOptions search, double born_per_scan, const core::FieldOfView& view);

}  // namespace helixnav::supervisor
