// SPDX-License-Identifier: BSD-3-Clause
#include "columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "own/vehicle/units.hpp"

namespace helixnav::logs {
namespace {

struct Unit {
  std::string_view ending;
  double factor;
};

constexpr std::array time_units{Unit{"s", 1.0}, Unit{"sec", 1.0}, Unit{"ms", 1e-3}, Unit{"us", 1e-6}, Unit{"ns", 1e-9}};
constexpr std::array length_units{Unit{"m", 1.0}, Unit{"cm", 1e-2}, Unit{"mm", 1e-3}};
constexpr std::array angle_units{Unit{"rad", 1.0}, Unit{"deg", rad_per_deg}};
constexpr std::array speed_units{Unit{"mps", 1.0},       Unit{"m_s", 1.0},        Unit{"m_per_s", 1.0},
                                 Unit{"kmh", 1.0 / 3.6}, Unit{"km_h", 1.0 / 3.6}, Unit{"km_per_h", 1.0 / 3.6}};
constexpr std::array turn_rate_units{
    Unit{"radps", 1.0},       Unit{"rad_s", 1.0},         Unit{"rad_per_s", 1.0},        Unit{"degps", rad_per_deg},
    Unit{"dps", rad_per_deg}, Unit{"deg_s", rad_per_deg}, Unit{"deg_per_s", rad_per_deg}};

std::pair<const Unit*, std::size_t> units_of(Measure measure) {
  switch (measure) {
    case Measure::time:
      return {time_units.data(), time_units.size()};
    case Measure::length:
      return {length_units.data(), length_units.size()};
    case Measure::angle:
      return {angle_units.data(), angle_units.size()};
    case Measure::speed:
      return {speed_units.data(), speed_units.size()};
    case Measure::turn_rate:
      return {turn_rate_units.data(), turn_rate_units.size()};
    default:
      return {nullptr, 0};
  }
}

/// "Range [m]" → "range_m": lower case, anything but a letter or digit becomes an underscore, none at the ends. Letters
/// beyond ASCII stay.
std::string plain(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0 || u >= 0x80) {
      result += static_cast<char>(std::tolower(u));
    } else if (!result.empty() && result.back() != '_') {
      result += '_';
    }
  }
  if (!result.empty() && result.back() == '_') result.pop_back();
  return result;
}

/// The factor of the unit when `name` is `stem` with or without a unit.
std::optional<double> factor_of(const std::string& name, std::string_view stem, Measure measure) {
  if (name == stem) return 1.0;
  const auto [units, count] = units_of(measure);
  if (name.compare(0, stem.size(), stem) != 0 || name.size() <= stem.size() || name[stem.size()] != '_') return {};
  const std::string_view ending = std::string_view(name).substr(stem.size() + 1);
  for (std::size_t i = 0; i < count; ++i) {
    if (units[i].ending == ending) return units[i].factor;
  }
  return {};
}

std::optional<double> factor_of(const std::string& name, const ColumnKind& kind) {
  if (const auto factor = factor_of(name, kind.name, kind.measure)) return factor;
  for (const std::string_view other : kind.other_names) {
    if (const auto factor = factor_of(name, other, kind.measure)) return factor;
  }
  return {};
}

/// All spellings that an error may suggest.
std::vector<std::string> spellings(const ColumnKind& kind) {
  std::vector<std::string> names{std::string(kind.name)};
  const auto [units, count] = units_of(kind.measure);
  for (std::size_t i = 0; i < count; ++i) names.push_back(names[0] + "_" + std::string(units[i].ending));
  for (const std::string_view other : kind.other_names) names.emplace_back(other);
  return names;
}

std::string with_unit(const ColumnKind& kind) {
  const auto [units, count] = units_of(kind.measure);
  return std::string(kind.name) + (count > 0 ? "_" + std::string(units[0].ending) : "");
}

/// So close that the other was meant: a letter wrong, two in a long name, or two swapped.
bool is_near(const std::string& a, const std::string& b) {
  const std::size_t distance = core::edit_distance(a, b);
  const bool swapped = distance == 2 && a.size() == b.size() && std::is_permutation(a.begin(), a.end(), b.begin());
  return distance <= (a.size() >= 7 ? std::size_t{2} : std::size_t{1}) || swapped;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 24;
  std::string shown = "'";
  for (const char c : text.substr(0, longest)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > longest ? "…'" : "'");
}

}  // namespace

TableColumns::TableColumns(std::string path, const std::vector<ColumnKind>& kinds,
                           const std::vector<std::string>& header, const std::vector<std::size_t>& header_columns,
                           std::size_t header_line)
    : path_(std::move(path)), kinds_(&kinds), header_(header), header_line_(header_line), found_(kinds.size()) {
  for (std::size_t cell = 0; cell < header_.size(); ++cell) add(cell, header_columns[cell]);
  judge_unknown();
}

void TableColumns::add(std::size_t cell, std::size_t column) {
  const std::string name = plain(header_[cell]);
  for (std::size_t kind = 0; kind < kinds_->size(); ++kind) {
    const std::optional<double> factor = factor_of(name, (*kinds_)[kind]);
    if (!factor) continue;
    if (found_[kind].cell != nowhere) fail_twice(kind, cell, column);
    const bool in_nanoseconds = (*kinds_)[kind].measure == Measure::time && *factor == 1e-9;
    found_[kind] = {cell, *factor, in_nanoseconds};
    return;
  }
  unknown_.push_back({name, column});
}

void TableColumns::fail_twice(std::size_t kind, std::size_t cell, std::size_t column) const {
  const std::string& first = header_[found_[kind].cell];
  const std::string what = first == header_[cell]
                               ? in_quotes(first) + " is there twice"
                               : in_quotes(first) + " and " + in_quotes(header_[cell]) + " are the same";
  fail_at(path_, header_line_, column, "column " + what + "; keep one");
}

void TableColumns::judge_unknown() {
  std::vector<std::string> missing;
  for (std::size_t kind = 0; kind < kinds_->size(); ++kind) {
    if (has(kind)) continue;
    for (std::string& name : spellings((*kinds_)[kind])) missing.push_back(std::move(name));
  }
  for (const Unknown& unknown : unknown_) {
    const std::string nearest = core::nearest_name(unknown.name, missing);
    if (unknown.name.size() > 2 && is_near(unknown.name, nearest)) {
      fail_at(path_, header_line_, unknown.column,
              "unknown column " + in_quotes(unknown.name) + "; did you mean '" + nearest + "'?");
    }
    unused_.push_back(unknown.name);
  }
}

std::string TableColumns::name_of(std::size_t kind) const {
  return has(kind) ? header_[found_[kind].cell] : with_unit((*kinds_)[kind]);
}

void TableColumns::require(std::size_t kind) const {
  if (has(kind)) return;
  std::string there;
  for (const std::string& name : header_) there += (there.empty() ? "" : ", ") + name;
  fail_header("expected a column " + with_unit((*kinds_)[kind]) + ", found only: " + there);
}

double Row::number(std::size_t kind) const {
  std::string_view text = cell(kind).text;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || stop != text.data() + text.size() || !std::isfinite(value)) {
    const bool comma = text.find(',') != std::string_view::npos;
    fail(kind, "expected a number" + std::string(comma ? " with a decimal point" : "") + " for " +
                   columns_.name_of(kind) + ", found " + (text.empty() ? "an empty cell" : in_quotes(cell(kind).text)));
  }
  return value * columns_.found(kind).factor;
}

double Row::number_between(std::size_t kind, double low, double high) const {
  const double value = number(kind);
  if (value >= low && value <= high) return value;
  std::array<char, 96> range{};
  const double factor = columns_.found(kind).factor;
  std::snprintf(range.data(), range.size(), " from %g to %g, found ", low / factor, high / factor);
  fail(kind, "expected " + columns_.name_of(kind) + range.data() + in_quotes(cell(kind).text));
}

double Row::positive(std::size_t kind) const {
  const double value = number(kind);
  if (value > 0.0) return value;
  fail(kind, "expected " + columns_.name_of(kind) + " greater than 0, found " + in_quotes(cell(kind).text));
}

double Row::angle(std::size_t kind) const {
  const double value_rad = number(kind);
  if (std::abs(value_rad) <= 2.0 * core::pi) return value_rad;
  const bool in_degrees = columns_.found(kind).factor != 1.0;
  fail(kind,
       "expected " + columns_.name_of(kind) +
           (in_degrees ? " within ±360 degrees" : " within ±2π radians; if it is in degrees, end its name in _deg") +
           ", found " + in_quotes(cell(kind).text));
}

core::Nanoseconds Row::time(std::size_t kind) const {
  constexpr double longest_s = 4e9;
  const double time_s = number_between(kind, -longest_s, longest_s);
  if (!columns_.found(kind).nanoseconds) return core::nanoseconds_from_seconds(time_s);
  const std::string_view text = cell(kind).text;
  core::Nanoseconds t_ns = 0;  // a double does not have enough digits for these
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), t_ns);
  const bool whole = error == std::errc{} && stop == text.data() + text.size();
  return whole ? t_ns : core::nanoseconds_from_seconds(time_s);
}

void Row::fail(std::size_t kind, const std::string& message) const {
  const std::size_t column = columns_.has(kind) ? cell(kind).column : 1;
  fail_at(columns_.path(), line_, column, message);
}

}  // namespace helixnav::logs
