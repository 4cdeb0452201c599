// SPDX-License-Identifier: BSD-3-Clause
#include "mat_nesting.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

#include <zlib.h>

namespace helixnav::logs {
namespace {

constexpr std::size_t tag_bytes = 8;
constexpr std::size_t type_matrix = 14;
constexpr std::size_t type_compressed = 15;
constexpr int deepest = 8;

/// Array flags are the first part of a matrix, its class their lowest byte; 1 to 3 are cells, structures and objects.
bool is_container(std::string_view matrix, bool little_endian) {
  constexpr std::size_t flags_at = 2 * tag_bytes;
  if (matrix.size() < flags_at + 4) return false;
  const std::size_t array_class = unsigned32(matrix, flags_at, little_endian) & 0xff;
  return array_class >= 1 && array_class <= 3;
}

/// `matrix` begins at its tag.
bool is_deeper(std::string_view matrix, int levels, bool little_endian) {
  if (!is_container(matrix, little_endian)) return false;
  if (levels == 0) return true;
  for (std::size_t at = tag_bytes; matrix.size() - at >= tag_bytes;) {
    const std::size_t type = unsigned32(matrix, at, little_endian);
    const bool is_small = type > 0xffff;  // four bytes of data at most, in the tag itself
    const std::size_t left = matrix.size() - at - tag_bytes;
    const std::size_t length = is_small ? 0 : std::min(left, unsigned32(matrix, at + 4, little_endian));
    if (type == type_matrix && is_deeper(matrix.substr(at, tag_bytes + length), levels - 1, little_endian)) return true;
    const std::size_t padded = std::min(left, (length + 7) / 8 * 8);
    at += tag_bytes + padded;
  }
  return false;
}

/// The first `most` bytes of what is compressed; fewer when there are no more, or none that can be read.
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

bool nests_too_deep(std::string_view element, bool little_endian) {
  const std::size_t type = unsigned32(element, 0, little_endian);
  if (type == type_matrix) return is_deeper(element, deepest, little_endian);
  if (type != type_compressed) return false;
  const std::string_view compressed = element.substr(tag_bytes);
  constexpr std::size_t head_bytes = 64;
  if (!is_container(inflated(compressed, head_bytes), little_endian)) return false;
  constexpr std::size_t most_bytes = 64u << 20;
  const std::string whole = inflated(compressed, most_bytes);
  return whole.size() == most_bytes || is_deeper(whole, deepest, little_endian);
}

}  // namespace helixnav::logs
