// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "byte_stream.hpp"
#include "helixnav/core/map_factors.hpp"
#include "little_endian.hpp"

namespace helixnav::runs {

/// The factors of a large map as map.bin holds them (docs/run-folder.md).
void put_factors(ByteStream& bytes, const core::MapFactors& map);

/// InputError naming the file if the bytes end too early, go on behind the factors, or refer to what is not there.
/// Whether the factors have a solution is not examined.
core::MapFactors take_factors(LittleEndian& bytes, const std::string& path);

}  // namespace helixnav::runs
