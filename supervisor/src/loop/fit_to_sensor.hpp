// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

/// Fits the lengths of the options to a sensor that reports how far it sees, unless fit_lengths is off. Before the
/// first scan the filter is started again if its cells change with them (what was predicted and fixed by then is in its
/// pose); true if it was. Test: supervisor/lengths_test.cpp.
bool fit_to_sensor(const core::FieldOfView& view, bool before_first_scan, NavigatorOptions& options,
                   cekf::CompressedEkf& filter);

}  // namespace helixnav::supervisor
