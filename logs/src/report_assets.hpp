// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace helixnav::logs {

/// Files of logs/report, compiled in by logs/report/embed.cmake.
extern const std::string_view report_page;
extern const std::string_view report_style;
extern const std::string_view report_script;
extern const std::string_view report_charts;  ///< Plotly, MIT licence

}  // namespace helixnav::logs
