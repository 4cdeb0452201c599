// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace helixnav::atlas {

/// A vector whose copies share what they have in common: a copy costs O(1), reading an element O(log N), and writing one
/// copies the blocks on its path unless this vector alone has written them since it was last copied.
/// Copies may be used in different threads, as those of std::vector may. Test: atlas/persistent_vector_test.cpp.
template <class T>
class PersistentVector {
 public:
  PersistentVector() = default;
  PersistentVector(const PersistentVector& other)
      : root_(other.root_), size_(other.size_), levels_(other.levels_), owner_(new_owner()) {
    other.owner_ = new_owner();  // from now on neither writes into what both hold
  }
  PersistentVector& operator=(const PersistentVector& other) {
    PersistentVector copy(other);
    root_ = std::move(copy.root_);
    size_ = copy.size_;
    levels_ = copy.levels_;
    owner_ = copy.owner_.load();
    return *this;
  }
  ~PersistentVector() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T& back() const { return (*this)[size_ - 1]; }

  const T& operator[](std::size_t index) const {
    const Block* block = root_.get();
    for (int level = levels_; level > 0; --level) block = block->below[digit(index, level)].get();
    return block->values[digit(index, 0)];
  }

  /// The element for writing. The reference is valid until this vector is copied.
  T& write(std::size_t index) {
    std::shared_ptr<Block>* block = &root_;
    for (int level = levels_; level > 0; --level) block = &own(*block, level).below[digit(index, level)];
    return own(*block, 0).values[digit(index, 0)];
  }

  void push_back(T value) {
    if (size_ == capacity()) {
      if (root_ != nullptr) {
        std::shared_ptr<Block> root = new_block(++levels_);
        root->below[0] = std::move(root_);
        root_ = std::move(root);
      } else {
        root_ = new_block(0);
      }
    }
    ++size_;
    write(size_ - 1) = std::move(value);
  }

 private:
  static constexpr int bits = 4;
  static constexpr std::size_t width = std::size_t{1} << bits;

  struct Block {
    std::uint64_t owner = 0;
    std::vector<std::shared_ptr<Block>> below;  // of inner blocks
    std::vector<T> values;                      // of the lowest ones
  };

  static std::uint64_t new_owner() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
  }
  static std::size_t digit(std::size_t index, int level) { return (index >> (bits * level)) & (width - 1); }
  std::size_t capacity() const { return root_ == nullptr ? 0 : std::size_t{1} << (bits * (levels_ + 1)); }

  std::shared_ptr<Block> new_block(int level) const {
    auto block = std::make_shared<Block>();
    block->owner = owner_;
    if (level > 0) {
      block->below.resize(width);
    } else {
      block->values.resize(width);
    }
    return block;
  }

  Block& own(std::shared_ptr<Block>& block, int level) {
    if (block == nullptr) {
      block = new_block(level);
    } else if (block->owner != owner_) {
      block = std::make_shared<Block>(*block);
      block->owner = owner_;
    }
    return *block;
  }

  std::shared_ptr<Block> root_;
  std::size_t size_ = 0;
  int levels_ = 0;
  mutable std::atomic<std::uint64_t> owner_{new_owner()};
};

}  // namespace helixnav::atlas
