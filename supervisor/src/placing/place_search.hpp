// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/decision.hpp"
#include "helixnav/relocalize/ask.hpp"
#include "placing/asked.hpp"
#include "placing/earlier_map.hpp"

namespace helixnav::supervisor {

/// An earlier map, ready to be asked where on it the vehicle is.
class PlaceSearch {
 public:
  PlaceSearch(const core::JointMap& earlier, const relocalize::IndexOptions& lengths);

  const EarlierMap& earlier() const { return earlier_; }
  const relocalize::IndexOptions& lengths() const { return index_.options(); }

  /// Whether it covers any ground.
  bool can_be_asked() const { return index_.looked_at_m2() > 0.0; }

  /// Whether a landmark there would be on the map.
  bool covers(const Eigen::Vector2d& point_m) const { return index_.has_looked_at(point_m); }

  /// The answer to the next question after `before`, also as a decision (nothing merged yet).
  relocalize::Answer ask(const relocalize::Question& question, const Asked& before,
                         core::PlacedDecision& decision) const;

 private:
  EarlierMap earlier_;
  relocalize::MapIndex index_;
};

}  // namespace helixnav::supervisor
