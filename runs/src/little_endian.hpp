// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace helixnav::runs {

static_assert(sizeof(double) == 8, "binary files of a run hold IEEE doubles");

/// Little-endian, whatever the machine.
template <class Unsigned>
void put_unsigned(std::string& bytes, Unsigned value) {
  std::array<char, sizeof(Unsigned)> little{};
  for (std::size_t k = 0; k < sizeof(Unsigned); ++k) little[k] = static_cast<char>((value >> (8 * k)) & 0xffU);
  bytes.append(little.data(), little.size());
}

inline void put(std::string& bytes, std::int32_t value) { put_unsigned(bytes, static_cast<std::uint32_t>(value)); }

inline void put(std::string& bytes, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_unsigned(bytes, bits);
}

/// Takes numbers off the front of bytes, of which there are enough: the caller has checked left().
class LittleEndian {
 public:
  explicit LittleEndian(std::string_view rest) : rest_(rest) {}

  std::size_t left() const { return rest_.size(); }

  template <class Unsigned>
  Unsigned take() {
    Unsigned value = 0;
    for (std::size_t k = 0; k < sizeof(Unsigned); ++k) {
      value |= static_cast<Unsigned>(static_cast<Unsigned>(static_cast<unsigned char>(rest_[k])) << (8 * k));
    }
    rest_.remove_prefix(sizeof(Unsigned));
    return value;
  }

  std::uint32_t small() { return take<std::uint32_t>(); }
  std::int32_t integer() { return static_cast<std::int32_t>(small()); }
  double number() {
    const auto bits = take<std::uint64_t>();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  std::string_view text(std::size_t size) {
    const std::string_view front = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return front;
  }

 private:
  std::string_view rest_;
};

}  // namespace helixnav::runs
