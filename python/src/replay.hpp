// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drive/earlier_session.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/runs/run.hpp"
#include "log.hpp"

namespace helixnav::python {

/// A map itself, or the path of one.
struct OldMap {
  std::optional<core::JointMap> map;
  std::filesystem::path path;
};

struct ReplayWishes {
  std::string out;  ///< run folder; empty: none is written
  bool overwrite = false;
  std::optional<OldMap> map;
  std::optional<apps::SessionStart> start;  ///< on it
  bool localize = false;
  bool smooth = false;
};

/// As the program's replay, to the last digit. Without the GIL, which it takes now and then to heed Ctrl-C: the folder is then whole
/// up to there, and what the signal raised is raised.
/// PreconditionError for wishes that exclude each other, InputError for a log or map that they cannot be had of.
runs::Run replay(const Log& log, const ReplayWishes& wishes);

}  // namespace helixnav::python
