// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "integrity/integrity_monitor.hpp"
#include "loop/belief.hpp"
#include "search/search.hpp"
#include "search/whole_map_questions.hpp"

namespace helixnav::supervisor {

/// Every scan is associated with the whole map. The integrity monitor checks that the map is where it should be; the
/// trusted checkpoint is the last one without evidence against that, and is missing only inside the step that ends a
/// search.
struct Mapping {
  IntegrityMonitor monitor;
  std::optional<Checkpoint> trusted;
  IntegrityMonitor monitor_when_trusted;

  void trust(Checkpoint checkpoint) {
    trusted.emplace(std::move(checkpoint));
    monitor_when_trusted = monitor;
  }
};

/// What was trusted before.
struct Trusted {
  Checkpoint checkpoint;
  IntegrityMonitor monitor;
};

/// A search is open: mapping goes on with the old landmarks excluded. The checkpoint is that of the trigger, after the
/// prediction and before its scan was used.
struct Searching {
  Search search;
  Checkpoint trigger;
  WholeMapQuestions questions_before = {};
  bool after_slip = false;  ///< nothing ties the branch to the old ground, not even odometry
  bool is_over = false;     ///< its scans are processed once more, only to map what they saw
};

using Mode = std::variant<Mapping, Searching>;

}  // namespace helixnav::supervisor
