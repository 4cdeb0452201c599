// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/branch_pairs.hpp"

namespace helixnav::supervisor {

/// Those of `ids` (ascending) that are on the map more than once: the first of each group is kept. All of a group are
/// compatible with each other and with no other landmark, by the same rules as leftovers(): a thousand times likelier to
/// be one than to be another one as near as the group's nearest neighbour. Two that were ever seen in one scan are known
/// relative to each other to a few centimetres and are not compatible. O(n) for landmarks that are spread out.
/// Test: supervisor/closing/mapped_twice_test.cpp.
KeptRemoved mapped_twice(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& ids,
                         const SearchOptions& options, const core::MapAppearance& appearance = {});

}  // namespace helixnav::supervisor
