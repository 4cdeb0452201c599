// SPDX-License-Identifier: BSD-3-Clause
//
// What depends on the version of MRPT, and nothing else does: built and tested with 2.5.8 (Debian 12). MRPT 3 changes
// more (getCurrentlyBuiltMapSize returns size_t, saveCurrentEstimationToImage has one argument) and is not supported.
#pragma once

#include <mrpt/version.h>

namespace mrpt::maps {
class CMultiMetricMap;
}

namespace helixnav::mrpt_adapter {

#if MRPT_VERSION >= 0x292
/// What CMetricMapBuilder::getCurrentlyBuiltMetricMap returns; the map belongs to the builder.
using MetricMapResult = const mrpt::maps::CMultiMetricMap&;
inline MetricMapResult metric_map_result(const mrpt::maps::CMultiMetricMap& map) { return map; }
#else
/// What CMetricMapBuilder::getCurrentlyBuiltMetricMap returns; the map belongs to the builder.
using MetricMapResult = const mrpt::maps::CMultiMetricMap*;
inline MetricMapResult metric_map_result(const mrpt::maps::CMultiMetricMap& map) { return &map; }
#endif

}  // namespace helixnav::mrpt_adapter
