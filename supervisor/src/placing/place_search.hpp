// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/core/decision.hpp"
#include "helixnav/relocalize/ask.hpp"
#include "placing/asked.hpp"
#include "placing/earlier_map.hpp"

namespace helixnav::supervisor {

/// A session that does not know where on an earlier map it is: when it asks, and how sure it wants to be (Asked).
class PlaceSearch {
 public:
  PlaceSearch(const core::JointMap& earlier, const relocalize::IndexOptions& lengths);

  const EarlierMap& earlier() const { return earlier_; }
  const relocalize::IndexOptions& lengths() const { return index_.options(); }

  /// As Asked, on ground that the earlier map covers.
  bool is_due(const std::vector<core::LandmarkId>& landmarks) const;

  /// The answer, and what it says as a decision (nothing merged yet).
  relocalize::Answer ask(const relocalize::Question& question, core::PlacedDecision& decision) const;

  /// Counts the question; true when its decision says something that the one before did not. Does not throw.
  bool asked(std::vector<core::LandmarkId>& landmarks, core::PlacedDecision::Verdict verdict) noexcept;

 private:
  EarlierMap earlier_;
  relocalize::MapIndex index_;
  Asked asked_;
  core::PlacedDecision::Verdict last_ = core::PlacedDecision::Verdict::sought;
};

}  // namespace helixnav::supervisor
