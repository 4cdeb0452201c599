// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace helixnav::reports {

/// Files of reports/page, compiled in by reports/page/embed.cmake.
extern const std::string_view report_page;
extern const std::string_view report_style;
extern const std::string_view report_script;
extern const std::string_view report_charts;  ///< Plotly, MIT licence

}  // namespace helixnav::reports
