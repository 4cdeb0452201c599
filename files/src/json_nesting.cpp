// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/files/json_nesting.hpp"

#include "helixnav/core/errors.hpp"

namespace helixnav::files {

void check_json_nesting(const std::string& path, std::string_view text) {
  constexpr int deepest = 64;
  int depth = 0;
  int line = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (in_string && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_string = !in_string;
    } else if (!in_string && (c == '[' || c == '{')) {
      ++depth;
    } else if (!in_string && (c == ']' || c == '}')) {
      --depth;
    }
    if (depth > deepest) {
      throw core::InputError(path + ':' + std::to_string(line) + ": JSON nested deeper than " +
                             std::to_string(deepest) + " levels");
    }
  }
}

}  // namespace helixnav::files
