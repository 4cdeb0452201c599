// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/appearance.hpp"

#include <algorithm>
#include <string>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {

ClassName::ClassName(std::string_view text) {
  if (text.size() > most_bytes || text.find('\0') != std::string_view::npos) {
    throw PreconditionError("class name '" + std::string(text) + "': expected at most " + std::to_string(most_bytes) +
                            " bytes, none of them zero");
  }
  std::copy(text.begin(), text.end(), text_.begin());
}

void LandmarkAppearance::add_vote(const ClassName& name, double nats) {
  /// Beyond, more of the same changes nothing, and one day's mistakes could never be outvoted.
  constexpr double most_nats = 30.0;
  const auto is_free = [&](const Vote& vote) { return vote.name == name || vote.name.empty(); };
  auto at = std::find_if(votes.begin(), votes.end(), is_free);
  if (at == votes.end()) {
    at = votes.end() - 1;
    if (at->nats >= nats) return;
    *at = Vote();
  }
  at->name = name;
  at->nats = std::min(most_nats, at->nats + nats);
  for (; at != votes.begin() && (at - 1)->nats < at->nats; --at) std::iter_swap(at - 1, at);
}

void LandmarkAppearance::add_size(double measured_m, double variance_m2, double says_nothing) {
  if (!(size_m > 0.0)) {
    size_m = measured_m;
    size_variance_m2 = variance_m2;
    return;
  }
  const double gain = size_variance_m2 / (size_variance_m2 + variance_m2);
  const double squares = size_variance_m2 * size_variance_m2 + variance_m2 * variance_m2;
  const double new_alone = says_nothing * size_variance_m2 * size_variance_m2 / squares;
  const double old_alone = says_nothing - new_alone;
  const double off_m = measured_m - size_m;
  const double moved_m = ((1.0 - says_nothing) * gain + new_alone) * off_m;
  const auto second_moment = [&](double at_m, double variance) {
    return variance + (at_m - moved_m) * (at_m - moved_m);
  };
  size_variance_m2 = (1.0 - says_nothing) * second_moment(gain * off_m, (1.0 - gain) * size_variance_m2) +
                     new_alone * second_moment(off_m, variance_m2) + old_alone * second_moment(0.0, size_variance_m2);
  size_m += moved_m;
}

LandmarkAppearance fused(const LandmarkAppearance& one, const LandmarkAppearance& other) {
  LandmarkAppearance both = one;
  for (const LandmarkAppearance::Vote& vote : other.votes) {
    if (!vote.name.empty()) both.add_vote(vote.name, vote.nats);
  }
  if (other.size_m > 0.0) both.add_size(other.size_m, other.size_variance_m2);
  return both;
}

}  // namespace helixnav::core
