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
void bind_map(py::module_& module);        // bind_map.cpp: Map, JointMap, read_map
void bind_navigator(py::module_& module);  // bind_navigator.cpp: navigators, reports, decisions
void bind_fastslam(py::module_& module);   // bind_fastslam.cpp: FastSlam
void bind_stream(py::module_& module);     // bind_stream.cpp: Stream
void bind_run(py::module_& module);        // bind_run.cpp: replay, Run, evaluate
void bind_join(py::module_& module);       // bind_join.cpp: join
void bind_team(py::module_& module);       // bind_team.cpp: Team, sightings, joins
void bind_team_log(py::module_& module);   // bind_team_log.cpp: its log and its run

}  // namespace helixnav::python
