// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace helixnav::reports {

inline std::string bytes_of_base64(std::string_view text) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(letters.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(held) & 255U);
  }
  return bytes;
}

/// What packed(numbers, order) was given.
inline std::vector<std::int64_t> unpacked(const std::string& text, int order) {
  std::vector<std::int64_t> numbers;
  std::array<std::int64_t, 3> sums{};
  std::uint64_t value = 0;
  unsigned shift = 0;
  for (const char c : bytes_of_base64(text)) {
    const auto byte = static_cast<unsigned char>(c);
    value |= static_cast<std::uint64_t>(byte & 127U) << shift;
    shift += 7;
    if (byte >= 128) continue;
    auto number = static_cast<std::int64_t>(value >> 1U) ^ -static_cast<std::int64_t>(value & 1U);
    for (int k = order - 1; k >= 0; --k) number = sums[static_cast<std::size_t>(k)] += number;
    numbers.push_back(number);
    value = 0;
    shift = 0;
  }
  return numbers;
}

}  // namespace helixnav::reports
