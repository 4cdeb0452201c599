// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::supervisor {

/// A slip is far for one linearisation: iterated, and once only where that does not settle.
inline cekf::UpdateResult update_after_slip(cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches) {
  try {
    return filter.update_iterated(matches);
  } catch (const core::NumericalError&) {
    return filter.update(matches);
  }
}

}  // namespace helixnav::supervisor
