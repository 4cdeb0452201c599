// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/files/number_text.hpp"

#include <charconv>
#include <cmath>
#include <limits>

namespace helixnav::files {

namespace {

template <typename T>
void append_chars(std::string& text, T value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, result.ptr);
}

template <typename T>
std::optional<T> parse_all(std::string_view text) {
  T value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

bool only_digits(std::string_view text) { return text.find_first_not_of("0123456789") == std::string_view::npos; }

}  // namespace

void append_number(std::string& text, double value) {
  if (std::isnan(value)) {
    text += "nan";  // the sign of a NaN says nothing and differs between machines
  } else {
    append_chars(text, value);
  }
}

void append_number(std::string& text, std::int64_t value) { append_chars(text, value); }

void append_seconds(std::string& text, core::Nanoseconds t_ns) {
  const bool negative = t_ns < 0;
  const auto magnitude =
      negative ? std::uint64_t{0} - static_cast<std::uint64_t>(t_ns) : static_cast<std::uint64_t>(t_ns);
  if (negative) text += '-';
  append_chars(text, magnitude / 1000000000U);
  const std::uint64_t fraction = magnitude % 1000000000U;
  if (fraction == 0) return;
  std::string digits = std::to_string(1000000000U + fraction);
  digits[0] = '.';
  digits.erase(digits.find_last_not_of('0') + 1);
  text += digits;
}

std::optional<double> parse_number(std::string_view text) { return parse_all<double>(text); }

std::optional<std::int64_t> parse_integer(std::string_view text) { return parse_all<std::int64_t>(text); }

std::optional<core::Nanoseconds> parse_seconds(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  const std::string_view magnitude = negative ? text.substr(1) : text;
  const std::size_t point = magnitude.find('.');
  const std::string_view whole = magnitude.substr(0, point);
  const std::string_view fraction = point == std::string_view::npos ? std::string_view{} : magnitude.substr(point + 1);
  if (!whole.empty() && whole.size() <= 10 && fraction.size() <= 9 && only_digits(whole) && only_digits(fraction)) {
    std::string digits(whole);
    digits += fraction;
    digits.append(9 - fraction.size(), '0');
    const std::optional<std::int64_t> t_ns = parse_integer(digits);
    return t_ns && negative ? -*t_ns : t_ns;
  }
  const std::optional<double> t_s = parse_number(text);
  if (!t_s || !(std::abs(*t_s) < 9e9)) return std::nullopt;
  return core::nanoseconds_from_seconds(*t_s);
}

}  // namespace helixnav::files
