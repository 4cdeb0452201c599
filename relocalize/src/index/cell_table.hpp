// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace helixnav::relocalize {

/// Numbers 0, 1, 2 … given to squares of the plane by their integer coordinates; open addressing, nothing is removed.
class CellTable {
 public:
  static constexpr std::uint32_t none = 0xFFFFFFFFU;

  std::uint32_t find(std::int32_t column, std::int32_t row) const {
    if (entries_.empty()) return none;
    const std::uint64_t key = pack(column, row);
    for (std::size_t i = hash(key) & (entries_.size() - 1);; i = (i + 1) & (entries_.size() - 1)) {
      if (entries_[i].number == none) return none;
      if (entries_[i].key == key) return entries_[i].number;
    }
  }

  /// The square's number, the next free one when it has none yet.
  std::uint32_t number(std::int32_t column, std::int32_t row) {
    const std::uint32_t known = find(column, row);
    if (known != none) return known;
    if (4 * (used_ + 1) > 3 * entries_.size()) grow();
    const auto fresh = static_cast<std::uint32_t>(used_++);
    place({pack(column, row), fresh});
    return fresh;
  }

  std::size_t size() const { return used_; }
  std::size_t memory_bytes() const { return entries_.capacity() * sizeof(Entry); }

 private:
  struct Entry {
    std::uint64_t key = 0;
    std::uint32_t number = none;
  };

  static std::uint64_t pack(std::int32_t column, std::int32_t row) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32U | static_cast<std::uint32_t>(row);
  }
  static std::size_t hash(std::uint64_t key) {  // splitmix64's finaliser
    key = (key ^ (key >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    key = (key ^ (key >> 27U)) * 0x94d049bb133111ebULL;
    return static_cast<std::size_t>(key ^ (key >> 31U));
  }
  void place(const Entry& entry) {
    std::size_t i = hash(entry.key) & (entries_.size() - 1);
    while (entries_[i].number != none) i = (i + 1) & (entries_.size() - 1);
    entries_[i] = entry;
  }
  void grow() {
    std::vector<Entry> old(entries_.empty() ? 16 : 2 * entries_.size());
    old.swap(entries_);
    for (const Entry& entry : old)
      if (entry.number != none) place(entry);
  }

  std::vector<Entry> entries_;
  std::size_t used_ = 0;
};

}  // namespace helixnav::relocalize
