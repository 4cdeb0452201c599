// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"
#include "update/iterate.hpp"

namespace helixnav::cekf {

/// The landmarks involved are named in workspace_.ids and active.
template <class Linearise>
UpdateResult CompressedEkf::iterate_and_apply(int max_iterations, const char* verb, const Linearise& linearise) {
  UpdateWorkspace& w = workspace_;
  gather_involved(w);
  InvolvedCorrection correction(options_.retraction, w);
  const double cost = iterate_to_minimum(correction, w, max_iterations, verb, linearise);
  if (!std::isfinite(cost)) throw core::NumericalError(problem_with(w, verb, "the iteration does not settle"));
  linearise_at_minimum(correction, w, verb, linearise);
  apply_correction(w, verb);
  return {cost, static_cast<int>(w.nu.rows())};
}

}  // namespace helixnav::cekf
