// SPDX-License-Identifier: BSD-3-Clause
#include "placing/index_traits.hpp"

#include <cmath>
#include <cstdint>

namespace helixnav::supervisor {
namespace {

/// FNV-1a of the name, 31 bits: of a hundred classes, two share a number once in half a million maps.
int number_of(const core::ClassName& name) {
  std::uint32_t hash = 2166136261U;
  for (const char letter : name.text()) hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619U;
  return static_cast<int>(hash >> 1U);
}

}  // namespace

void tell_traits(const core::LandmarkAppearance& known, relocalize::Landmark& landmark) {
  if (!known.votes.front().name.empty()) landmark.kind = number_of(known.votes.front().name);
  if (known.size_m > 0.0) landmark.size = relocalize::Size{known.size_m, std::sqrt(known.size_variance_m2)};
}

}  // namespace helixnav::supervisor
