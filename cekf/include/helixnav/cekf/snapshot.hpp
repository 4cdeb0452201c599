// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "helixnav/cekf/active_part.hpp"
#include "helixnav/cekf/packed_triangle.hpp"

namespace helixnav::cekf {

/// The filter at one instant. Small, O(n_a²), because the passive part is frozen inside a phase; valid as long as
/// the filter that made it keeps that phase (CompressedEkf::keep_since).
struct Snapshot {
  long phase = -1;
  ActivePart active;  ///< without P and M
  PackedTriangle P;
  PackedTriangle M;

  std::size_t bytes() const;
};

}  // namespace helixnav::cekf
