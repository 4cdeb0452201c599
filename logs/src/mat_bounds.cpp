// SPDX-License-Identifier: BSD-3-Clause
#include "mat_bounds.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <zlib.h>

namespace helixnav::logs {
namespace {

constexpr std::size_t tag_bytes = 8;
constexpr std::size_t type_matrix = 14;
constexpr std::size_t type_compressed = 15;
constexpr int deepest = 8;

/// Array flags are the first part of a matrix, with its class in their lowest byte; 1 to 3 are cells, structures and
/// objects.
std::size_t class_of(std::string_view matrix, bool little_endian) {
  constexpr std::size_t flags_at = 2 * tag_bytes;
  return matrix.size() < flags_at + 4 ? 0 : unsigned32(matrix, flags_at, little_endian) & 0xff;
}

bool is_container(std::string_view matrix, bool little_endian) {
  const std::size_t array_class = class_of(matrix, little_endian);
  return array_class >= 1 && array_class <= 3;
}

/// A part of a matrix: type and data, which may be cut off.
struct Part {
  std::size_t type = 0;
  std::size_t length = 0;  ///< as stated in the file
  std::string_view data;
  std::string_view with_tag;
};

Part part_at(std::string_view matrix, std::size_t at, bool little_endian) {
  Part part;
  part.type = unsigned32(matrix, at, little_endian);
  const bool is_small = part.type > 0xffff;  // at most four bytes of data, in the tag itself
  part.length = is_small ? part.type >> 16 : unsigned32(matrix, at + 4, little_endian);
  const std::size_t from = at + (is_small ? 4 : tag_bytes);
  part.data = matrix.substr(from, is_small ? std::min<std::size_t>(part.length, 4) : part.length);
  part.with_tag = matrix.substr(at, is_small ? tag_bytes : tag_bytes + part.data.size());
  return part;
}

/// `matrix` starts at its tag.
std::vector<Part> parts_of(std::string_view matrix, std::size_t most, bool little_endian) {
  std::vector<Part> parts;
  for (std::size_t at = tag_bytes; at <= matrix.size() && matrix.size() - at >= tag_bytes && parts.size() < most;) {
    parts.push_back(part_at(matrix, at, little_endian));
    at += (parts.back().with_tag.size() + 7) / 8 * 8;
  }
  return parts;
}

/// The array flags are the first part, of eight bytes, which is what matio takes whatever length is given: with another
/// length it would continue at a different place than we do.
bool has_flags(const std::vector<Part>& parts) { return parts.empty() || parts[0].length == 8; }

/// The dimensions are the second part, of four bytes each.
bool has_few_dimensions(const std::vector<Part>& parts) { return parts.size() < 2 || parts[1].length <= 4 * 32; }

/// The name is the third part.
bool has_short_name(const std::vector<Part>& parts) { return parts.size() < 3 || parts[2].length <= 1024; }

/// Every cell, and every field of a structure, is a matrix with its own tag. The fourth part of a structure is the
/// length of a field's name, the fifth the names.
bool has_room_for_cells(const std::vector<Part>& parts, std::size_t bytes, std::size_t array_class,
                        bool little_endian) {
  if (parts.size() < 2) return true;
  std::size_t cells = 1;
  const auto count = [&](std::size_t more) { cells = more > 0 && cells > bytes / more ? bytes + 1 : cells * more; };
  for (std::size_t at = 0; at + 4 <= parts[1].data.size(); at += 4) {
    count(unsigned32(parts[1].data, at, little_endian));
  }
  if (array_class != 1 && parts.size() > 4 && parts[3].data.size() == 4) {
    const std::size_t name_bytes = std::max<std::size_t>(1, unsigned32(parts[3].data, 0, little_endian));
    count((parts[4].length + name_bytes - 1) / name_bytes);
  }
  return cells <= bytes / tag_bytes;
}

/// `matrix` starts at its tag.
std::string_view broken_bound_of_matrix(std::string_view matrix, int levels, bool little_endian) {
  constexpr std::size_t head = 5;
  const std::vector<Part> first = parts_of(matrix, head, little_endian);
  if (!has_flags(first)) return "array flags of 8 bytes";
  if (!has_few_dimensions(first)) return "at most 32 dimensions";
  if (!has_short_name(first)) return "a name of at most 1024 bytes";
  if (!is_container(matrix, little_endian)) return {};
  if (levels == 0) return "cells and structures at most 8 deep";
  if (!has_room_for_cells(first, matrix.size(), class_of(matrix, little_endian), little_endian)) {
    return "no more cells and fields than there are bytes for";
  }
  for (const Part& part : parts_of(matrix, matrix.size(), little_endian)) {
    if (part.type != type_matrix) continue;
    const std::string_view bound = broken_bound_of_matrix(part.with_tag, levels - 1, little_endian);
    if (!bound.empty()) return bound;
  }
  return {};
}

/// The first `most` bytes of the compressed data; fewer when there are no more, or none that can be read.
std::string inflated(std::string_view compressed, std::size_t most) {
  std::string bytes(most, '\0');
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
  stream.avail_in = static_cast<uInt>(compressed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(most);
  inflate(&stream, Z_SYNC_FLUSH);
  bytes.resize(most - stream.avail_out);
  inflateEnd(&stream);
  return bytes;
}

}  // namespace

std::size_t unsigned32(std::string_view content, std::size_t at, bool little_endian) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = (value << 8) | static_cast<unsigned char>(content[at + (little_endian ? 3 - i : i)]);
  }
  return value;
}

std::string_view broken_bound(std::string_view element, bool little_endian) {
  const std::size_t type = unsigned32(element, 0, little_endian);
  if (type == type_matrix) return broken_bound_of_matrix(element, deepest, little_endian);
  if (type != type_compressed) return {};
  const std::string_view compressed = element.substr(tag_bytes);
  constexpr std::size_t head_bytes = 64;
  const std::string head = inflated(compressed, head_bytes);
  if (!is_container(head, little_endian)) return broken_bound_of_matrix(head, deepest, little_endian);
  constexpr std::size_t most_bytes = 64u << 20;
  const std::string whole = inflated(compressed, most_bytes);
  if (whole.size() == most_bytes) return "cells and structures of at most 64 MiB";
  return broken_bound_of_matrix(whole, deepest, little_endian);
}

}  // namespace helixnav::logs
