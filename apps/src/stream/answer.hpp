// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "helixnav/core/step_report.hpp"
#include "helixnav/logs/own_stream.hpp"

namespace helixnav::apps {

/// The lines that stream answers with, JSON objects of one key each (docs/live.md); numbers read back as the same double.

/// {"scan": …}: pose, covariance, mode, associations and decisions of a step. `line` is the input's.
std::string scan_answer(const core::StepReport& report, std::size_t line);
/// {"refused": …}
std::string refused_answer(const logs::RefusedLine& refused);
/// {"note": …}
std::string note_answer(const std::string& words);
/// {"end": …}
std::string end_answer(std::int64_t scans, std::int64_t refused, const std::string& why);

}  // namespace helixnav::apps
