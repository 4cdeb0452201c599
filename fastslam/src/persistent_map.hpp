// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "landmark_record.hpp"
#include "node_pool.hpp"

namespace helixnav::fastslam {

/// The landmarks of one particle: a persistent 16-way trie over lineage ids with leaves of eight landmarks. Maps share
/// what they have in common: `share` costs one count, and a write copies the nodes on its path that are used
/// elsewhere, or writes in place if they are not. Depth log₁₆(id / 8). Different maps may be written by different
/// threads at the same time, each with a pool of its own that was told that it is not alone. The owner of a map clears
/// it: the pool is not known here. Test: fastslam/persistent_map_test.cpp (random programs against std::map).
class PersistentMap {
 public:
  PersistentMap() = default;
  PersistentMap(PersistentMap&& other) noexcept
      : root_(std::exchange(other.root_, nullptr)),
        levels_(std::exchange(other.levels_, 0U)),
        size_(std::exchange(other.size_, 0U)) {}
  PersistentMap& operator=(PersistentMap&& other) noexcept {
    std::swap(root_, other.root_);
    std::swap(levels_, other.levels_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~PersistentMap() = default;

  std::size_t size() const { return size_; }

  /// nullptr when there is none. Valid until the next write.
  const LandmarkRecord* find(LineageId id) const {
    if (!covers(id)) return nullptr;
    const void* at = root_;
    for (std::uint32_t level = levels_; level > 0 && at != nullptr; --level) {
      at = static_cast<const MapNode*>(at)->child[slot(id, level)];
    }
    const auto* leaf = static_cast<const MapLeaf*>(at);
    return leaf != nullptr && (leaf->present >> (id & 7U) & 1U) != 0 ? &leaf->landmark[id & 7U] : nullptr;
  }

  /// The landmark, to be written; a new one has unspecified contents. Valid until the next call on this map.
  LandmarkRecord& write(LineageId id, NodePool& pool);

  /// Takes the landmark out; no effect when there is none.
  void erase(LineageId id, NodePool& pool);

  /// Becomes a copy of `other`.
  void share(const PersistentMap& other, NodePool& pool);

  /// Becomes empty.
  void clear(NodePool& pool);

  /// f(id, landmark) for all, by ascending id.
  template <class Function>
  void for_each(Function&& f) const {
    if (root_ != nullptr) visit(root_, levels_, 0, f);
  }

  /// f(first id, leaf) for all leaves, by ascending id; skips what `seen_before(node or leaf)` says was visited.
  template <class Seen, class Function>
  void for_each_leaf(Seen&& seen_before, Function&& f) const {
    if (root_ != nullptr) visit_leaves(root_, levels_, 0, seen_before, f);
  }

 private:
  bool covers(LineageId id) const { return (static_cast<std::uint64_t>(id) >> (3 + 4 * levels_)) == 0; }
  static std::uint32_t slot(LineageId id, std::uint32_t level) { return id >> (4 * level - 1) & 15U; }
  void grow_to(LineageId id, NodePool& pool);

  template <class Function>
  static void visit(const void* at, std::uint32_t level, LineageId first, Function& f) {
    const auto each = [&](LineageId id, const MapLeaf& leaf) {
      for (std::uint32_t k = 0; k < 8; ++k) {
        if ((leaf.present >> k & 1U) != 0) f(id + k, leaf.landmark[k]);
      }
    };
    const auto never = [](const void*) { return false; };
    visit_leaves(at, level, first, never, each);
  }
  template <class Seen, class Function>
  static void visit_leaves(const void* at, std::uint32_t level, LineageId first, Seen& seen, Function& f) {
    if (seen(at)) return;
    if (level == 0) {
      f(first, *static_cast<const MapLeaf*>(at));
      return;
    }
    for (std::uint32_t k = 0; k < 16; ++k) {
      const void* child = static_cast<const MapNode*>(at)->child[k];
      if (child != nullptr) visit_leaves(child, level - 1, first + (k << (4 * level - 1)), seen, f);
    }
  }

  void* root_ = nullptr;
  std::uint32_t levels_ = 0;  // of nodes above the leaves
  std::uint32_t size_ = 0;    // landmarks
};

}  // namespace helixnav::fastslam
