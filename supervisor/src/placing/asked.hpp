// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/relocalize/ask.hpp"

namespace helixnav::supervisor {

/// A session's map bends, and its landmarks share errors, but the evidence is that of independent pairs: it is asked
/// for without what its density would spare.
inline relocalize::AskOptions session_options(double alpha) {
  relocalize::AskOptions options;
  options.alpha = alpha;
  options.evidence_density = 1.0;
  return options;
}

/// Questions to a map about where the vehicle is on it: how many there were, and with which landmarks the last one was asked.
struct Asked {
  static constexpr std::size_t least_to_ask = 8;  ///< landmarks

  int questions = 0;
  std::vector<core::LandmarkId> with;  ///< ascending
  std::size_t most_about = 0;          ///< landmarks about the vehicle at once, before the first question

  /// Enough landmarks to ask with, and enough of them new since the last question: a fifth if somebody is waiting for
  /// the answer, half if nobody is.
  bool is_due(const std::vector<core::LandmarkId>& landmarks, double least_new = 0.2) const {
    const auto fresh = std::count_if(landmarks.begin(), landmarks.end(), [&](core::LandmarkId id) {
      return !std::binary_search(with.begin(), with.end(), id);
    });
    return landmarks.size() >= least_to_ask &&
           static_cast<double>(fresh) >= least_new * static_cast<double>(landmarks.size());
  }

  /// α/(k(k+1)) for the k-th question, so that α is the probability of a false answer among all of them, however many.
  double next_alpha() const {
    constexpr double alpha = 1e-5;
    const double k = questions + 1;
    return alpha / (k * (k + 1.0));
  }

  /// Counts a question asked with these, in any order, which are swapped away. Does not throw.
  void note(std::vector<core::LandmarkId>& landmarks) noexcept {
    ++questions;
    std::sort(landmarks.begin(), landmarks.end());
    with.swap(landmarks);
  }
};

}  // namespace helixnav::supervisor
