// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "helixnav/files/number_text.hpp"

namespace helixnav::files {

/// Further cells of a row, each preceded by a comma. Test: runs/run_writer_test.cpp.
inline void append_cells(std::string& text, std::initializer_list<double> values) {
  for (const double value : values) {
    text += ',';
    append_number(text, value);
  }
}

inline void append_counts(std::string& text, std::initializer_list<std::int64_t> values) {
  for (const std::int64_t value : values) {
    text += ',';
    append_number(text, value);
  }
}

}  // namespace helixnav::files
