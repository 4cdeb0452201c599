// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::supervisor {

/// A slip is far for one linearisation: iterated, or once only if that does not settle, which is a repair.
inline cekf::UpdateResult update_after_slip(cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches,
                                            core::NumericalHealth& numerics) {
  try {
    return filter.update_iterated(matches);
  } catch (const core::NumericalError&) {
    const cekf::UpdateResult result = filter.update(matches);
    ++numerics.repaired;
    return result;
  }
}

/// Again, for a scan that was already reported: not a new repair.
inline cekf::UpdateResult update_after_slip(cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches) {
  core::NumericalHealth numerics;
  return update_after_slip(filter, matches, numerics);
}

}  // namespace helixnav::supervisor
