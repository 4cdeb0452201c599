// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::supervisor {

/// The sensor's reach that default-constructed options stand for.
constexpr double reference_reach_m = 30.0;

/// A length (or a density) of the navigator in force, as written into manifests.
struct LengthInForce {
  std::string_view name;  ///< section.key, as of a configuration file where it is a key of one
  double value = 0.0;     ///< [m], or [1/m²] of a density
};

/// The options for a sensor of this field of view; as they are when it says nothing of the reach. Whatever is a length in
/// mapping, search, verification and closing is a multiple of the reach: a world, its sensor and its noise at a tenth of
/// their size are navigated as the original is. The multiples stand in lengths.cpp, in one table, and nowhere else. A
/// landmark gets old the later the narrower the view is, because the vehicle loses it by turning, too: after one reach for
/// every view that it takes to look all around, two at the least. A length that is not that of reference_reach_m was
/// chosen by the caller and stays.
/// Test: supervisor/lengths_test.cpp (a world at 1/8 of its size is associated and closed alike, to the last decision).
NavigatorOptions fit_lengths(NavigatorOptions options, const core::FieldOfView& view);

/// All rows of that table with their values in `options`, in its order.
std::vector<LengthInForce> lengths_in_force(const NavigatorOptions& options);

/// Sets one of them by its name; PreconditionError for an unknown one.
void set_length(NavigatorOptions& options, std::string_view name, double value);

/// The search with the densities of objects that are in no map: as told, or, where they are to be learnt, `born_per_scan`
/// (LandmarkLife::born_per_scan) in the area of `view`.
SearchOptions with_foreign(SearchOptions search, double born_per_scan, const core::FieldOfView& view);

}  // namespace helixnav::supervisor
