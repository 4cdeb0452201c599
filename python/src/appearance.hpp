// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bind.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::python {

/// What the objects of a scan look like: None or "" for a class that is not given, NaN for a size. core::PreconditionError for
/// what does not fit the scan.
void tell_appearance(const py::object& classes, const py::object& sizes, const py::object& sigma_sizes,
                     double class_error, core::Scan& scan);

/// "" where none is given.
std::vector<std::string> classes_of(const core::Scan& scan);

/// Appearance::size_m or sigma_size_m of each; NaN where a size is not given.
py::array_t<double> sizes_of(const core::Scan& scan, double core::Appearance::*value);

}  // namespace helixnav::python
