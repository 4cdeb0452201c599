// SPDX-License-Identifier: BSD-3-Clause
#include "loop/fit_to_sensor.hpp"

#include <utility>

#include "helixnav/supervisor/lengths.hpp"

namespace helixnav::supervisor {

bool fit_to_sensor(const core::FieldOfView& view, bool before_first_scan, NavigatorOptions& options,
                   cekf::CompressedEkf& filter) {
  if (!options.fit_lengths) return false;
  NavigatorOptions fitted = fit_lengths(options, view);
  const bool new_cells = fitted.filter.cell_side_m != options.filter.cell_side_m ||
                         fitted.filter.hysteresis_m != options.filter.hysteresis_m;
  const bool start_again = new_cells && before_first_scan;
  if (start_again) {
    filter = cekf::CompressedEkf(filter.joint(filter.landmarks()), filter.next_name(), fitted.filter);
  }
  options = std::move(fitted);
  return start_again;
}

}  // namespace helixnav::supervisor
