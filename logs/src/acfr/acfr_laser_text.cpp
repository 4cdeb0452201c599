// SPDX-License-Identifier: BSD-3-Clause
#include "acfr_laser_text.hpp"

#include <cmath>
#include <cstdint>

#include "input_files.hpp"
#include "reading_times.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

/// The text release has the ranges in metres with two decimals; the scanner sent them as whole centimetres.
std::uint16_t centimetres(TextCursor& cursor) {
  const double range_m = cursor.number_between_in_stream(0.0, 655.35, "a range [m], one of 361 in a scan");
  return static_cast<std::uint16_t>(std::lround(range_m * 100.0));
}

}  // namespace

std::vector<SickScan> parse_laser_text(std::string_view text, const std::string& file_name) {
  TextCursor cursor(text, file_name, ' ', TextCursor::Place::byte);
  std::vector<SickScan> scans;
  ReadingTimes times;
  while (!cursor.at_end()) {
    SickScan& scan = scans.emplace_back();
    scan.t_ns = times.next(cursor);
    for (std::uint16_t& range_cm : scan.range_cm) {
      range_cm = centimetres(cursor);
    }
  }
  return scans;
}

std::vector<SickScan> find_laser_text(const std::filesystem::path& folder) {
  const std::filesystem::path plain = folder / laser_file;
  const std::filesystem::path zip = folder / "victoria_park_ascii.zip";
  if (std::filesystem::exists(plain)) {
    return parse_laser_text(read_file(plain), plain.string());
  }
  if (!std::filesystem::exists(zip)) {
    return {};
  }
  const TextByName texts = read_archive(zip, {laser_file});
  const auto found = texts.find(laser_file);
  return found == texts.end() ? std::vector<SickScan>() : parse_laser_text(found->second, (zip / laser_file).string());
}

}  // namespace helixnav::logs
