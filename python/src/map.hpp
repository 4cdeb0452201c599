// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/step_report.hpp"

namespace helixnav::python {

/// A map, and a decision, as types of their own for Python.
struct Map {
  std::vector<core::MapLandmark> landmarks;
};
struct Decided {
  core::Decision decision;
  std::string sentence = {};  ///< where it is told in other words than all of its kind
};

}  // namespace helixnav::python
