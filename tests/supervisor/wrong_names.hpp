// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

#include "helixnav/core/random.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::supervisor {

/// Gives every sighting another name from the recording with this probability; one without a name stays without.
inline core::Recording with_wrong_names(core::Recording run, double probability, std::uint64_t seed) {
  std::set<core::Label> all;
  for (const auto& scan : run.labels) all.insert(scan.begin(), scan.end());
  all.erase(core::no_label);
  const std::vector<core::Label> names(all.begin(), all.end());
  core::RandomStream random(seed, "wrong names");
  for (auto& scan : run.labels) {
    for (core::Label& name : scan) {
      const bool is_wrong = random.uniform() < probability;
      const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(names.size()));
      if (is_wrong && name != core::no_label) name = names[std::min(other, names.size() - 1)];
    }
  }
  return run;
}

/// The very first sighting is by the name of the landmark that is seen last.
inline core::Recording with_a_wrong_first_name(core::Recording run) {
  std::vector<core::Label> in_order;
  core::Label* first = nullptr;
  for (auto& scan : run.labels) {
    for (core::Label& name : scan) {
      if (name == core::no_label) continue;
      if (first == nullptr) first = &name;
      if (std::find(in_order.begin(), in_order.end(), name) == in_order.end()) in_order.push_back(name);
    }
  }
  *first = in_order.back();
  return run;
}

}  // namespace helixnav::supervisor
