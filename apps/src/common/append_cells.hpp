// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>

#include "helixnav/files/number_text.hpp"

namespace helixnav::apps {

/// Numbers as further cells of a row, each after a comma.
inline void append_cells(std::string& text, std::initializer_list<double> numbers) {
  for (const double number : numbers) {
    text += ',';
    files::append_number(text, number);
  }
}

}  // namespace helixnav::apps
