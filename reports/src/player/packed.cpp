// SPDX-License-Identifier: BSD-3-Clause
#include "packed.hpp"

#include <array>
#include <cmath>
#include <string_view>

namespace helixnav::reports {
namespace {

void append_bytes_of(std::int64_t number, std::string& bytes) {
  auto rest = (static_cast<std::uint64_t>(number) << 1U) ^ static_cast<std::uint64_t>(number < 0 ? -1 : 0);
  for (; rest >= 128; rest >>= 7U) bytes += static_cast<char>((rest & 127U) | 128U);
  bytes += static_cast<char>(rest);
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_filler = i + k > bytes.size();
      text += is_filler ? '=' : letters[group >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

}  // namespace

std::string packed(const std::vector<std::int64_t>& numbers, int order) {
  std::string bytes;
  std::array<std::int64_t, 3> before{};  // the last number, the last difference, …
  for (const std::int64_t number : numbers) {
    std::int64_t difference = number;
    for (int k = 0; k < order; ++k) {
      const std::int64_t next = difference - before[static_cast<std::size_t>(k)];
      before[static_cast<std::size_t>(k)] = difference;
      difference = next;
    }
    append_bytes_of(difference, bytes);
  }
  return base64(bytes);
}

std::int64_t quantised(double value, double unit) {
  constexpr double most = 1e9;
  const double steps = std::round(value / unit);
  return std::abs(steps) <= most ? static_cast<std::int64_t>(steps) : 0;
}

}  // namespace helixnav::reports
