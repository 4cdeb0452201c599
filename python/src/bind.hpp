// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace helixnav::python {

namespace py = pybind11;

/// Each adds a part of the module, in this order.
void bind_events(py::module_& module);     // bind_events.cpp: pose, field of view, odometry, scan, fix
void bind_log(py::module_& module);        // bind_log.cpp: Log, read_log, simulate
void bind_navigator(py::module_& module);  // bind_navigator.cpp: navigators, reports, decisions, map
void bind_run(py::module_& module);        // bind_run.cpp: replay, Run, evaluate

}  // namespace helixnav::python
