// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace helixnav::reports {

/// Integers as short text, for tables too long for JSON: their differences (of differences, …: `order` times), each as a
/// zigzag number in bytes of seven bits, low bits first, all in base64. reports/page/unpack.js reads it.
/// Test: reports/packed_test.cpp.
std::string packed(const std::vector<std::int64_t>& numbers, int order);

/// `value` in steps of `unit`; 0 if it is not finite.
std::int64_t quantised(double value, double unit);

}  // namespace helixnav::reports
