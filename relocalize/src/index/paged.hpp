// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace helixnav::relocalize {

/// An array that grows by pages and never copies what it holds: a growing std::vector would hold up to twice its contents.
template <class T, unsigned page_bits>
class Paged {
 public:
  static constexpr std::size_t page_size = std::size_t{1} << page_bits;

  T& operator[](std::size_t i) { return pages_[i >> page_bits][i & (page_size - 1)]; }
  const T& operator[](std::size_t i) const { return pages_[i >> page_bits][i & (page_size - 1)]; }
  std::size_t size() const { return size_; }

  std::uint32_t push_back(const T& value) {
    if (size_ == pages_.size() * page_size) pages_.emplace_back(page_size);
    (*this)[size_] = value;
    return static_cast<std::uint32_t>(size_++);
  }

  std::size_t memory_bytes() const {
    return pages_.size() * page_size * sizeof(T) + pages_.capacity() * sizeof(pages_[0]);
  }

 private:
  std::vector<std::vector<T>> pages_;  ///< of page_size each
  std::size_t size_ = 0;
};

/// Values by number where most numbers, or long runs of them, have the default value and cost nothing.
template <class T>
class SparsePages {
 public:
  explicit SparsePages(const T& otherwise) : otherwise_(otherwise) {}

  const T& operator[](std::size_t i) const {
    const std::size_t page = i / page_size;
    return page < pages_.size() && !pages_[page].empty() ? pages_[page][i % page_size] : otherwise_;
  }
  void set(std::size_t i, const T& value) {
    const std::size_t page = i / page_size;
    if (page >= pages_.size()) pages_.resize(page + 1);
    if (pages_[page].empty()) {
      pages_[page].assign(page_size, otherwise_);
      ++used_;
    }
    pages_[page][i % page_size] = value;
  }
  std::size_t memory_bytes() const { return used_ * page_size * sizeof(T) + pages_.capacity() * sizeof(pages_[0]); }

 private:
  static constexpr std::size_t page_size = 256;
  T otherwise_;
  std::vector<std::vector<T>> pages_;  ///< of page_size each, or empty
  std::size_t used_ = 0;
};

}  // namespace helixnav::relocalize
