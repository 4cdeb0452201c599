// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "placing/asked.hpp"
#include "search/old_ground_index.hpp"

namespace helixnav::supervisor {

/// What was asked of the whole map so far, by all searches and outside of any: they share one probability of a false answer.
struct WholeMapQuestions {
  Asked asked;
  double next_path_m = 0.0;  ///< length of the drive when it is asked next whether ground is new
  std::shared_ptr<const OldGroundIndex> old_ground;  ///< null before the first question
};

}  // namespace helixnav::supervisor
