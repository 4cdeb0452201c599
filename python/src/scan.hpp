// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bind.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::python {

/// A scan of a kind, "range_bearing" …, with z (N, d) and R (d, d) or (N, d, d). TypeError and core::PreconditionError for
/// what no sensor measures.
core::Scan scan_from(double t_s, const std::string& kind, const py::object& z, const py::object& R,
                     const py::object& mounting, const core::FieldOfView& view);

}  // namespace helixnav::python
