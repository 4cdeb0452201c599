// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "landmark_record.hpp"

namespace helixnav::fastslam {

/// Inner node of a map: sixteen children, nodes or leaves by level. `count`: how many parents and maps point here.
struct MapNode {
  std::atomic<std::uint32_t> count;
  void* child[16];
};

/// Leaf of a map: eight landmarks of successive lineages, bit k of `present` says whether landmark[k] is one.
struct MapLeaf {
  std::atomic<std::uint32_t> count;
  std::uint32_t present;
  LandmarkRecord landmark[8];
};

/// Memory of one type, taken from the system in blocks and given back when the pool goes.
template <class T>
class FreeList {
 public:
  T* take() {
    if (free_.empty()) add_block();
    T* item = free_.back();
    free_.pop_back();
    return item;
  }
  void put(T* item) { free_.push_back(item); }

  /// Moves free items to `other` until both have equally many.
  void share_with(FreeList& other) {
    while (free_.size() > other.free_.size() + 1) {
      other.free_.push_back(free_.back());
      free_.pop_back();
    }
  }
  std::size_t free_items() const { return free_.size(); }
  std::size_t reserved_bytes() const { return blocks_.size() * block_items * sizeof(T); }

 private:
  static constexpr std::size_t block_items = 65536 / sizeof(T);

  void add_block() {
    blocks_.push_back(std::make_unique<T[]>(block_items));
    for (std::size_t k = block_items; k-- > 0;) free_.push_back(&blocks_.back()[k]);
  }

  std::vector<std::unique_ptr<T[]>> blocks_;
  std::vector<T*> free_;
};

/// Nodes and leaves for the maps that one worker writes. What is taken from one pool may be put into another.
class NodePool {
 public:
  /// `alone`: no other thread touches nodes of the same maps, so that counts need no locked instructions.
  explicit NodePool(bool alone) : alone_(alone) {}

  MapNode* take_node() { return counted(nodes_.take()); }
  MapLeaf* take_leaf() { return counted(leaves_.take()); }
  void put(MapNode* node) { nodes_.put(node), live_bytes_ -= static_cast<std::ptrdiff_t>(sizeof(MapNode)); }
  void put(MapLeaf* leaf) { leaves_.put(leaf), live_bytes_ -= static_cast<std::ptrdiff_t>(sizeof(MapLeaf)); }

  void increment(std::atomic<std::uint32_t>& count) const {
    if (alone_) {
      count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    } else {
      count.fetch_add(1, std::memory_order_relaxed);
    }
  }
  /// True when that was the last one.
  bool decrement(std::atomic<std::uint32_t>& count) const {
    if (!alone_) return count.fetch_sub(1, std::memory_order_acq_rel) == 1;
    const std::uint32_t left = count.load(std::memory_order_relaxed) - 1;
    count.store(left, std::memory_order_relaxed);
    return left == 0;
  }

  /// Bytes taken minus bytes put: of all pools of the same maps together, what their nodes occupy.
  std::ptrdiff_t live_bytes() const { return live_bytes_; }
  std::size_t reserved_bytes() const { return nodes_.reserved_bytes() + leaves_.reserved_bytes(); }

  /// Evens out the free items of both.
  void balance(NodePool& other) {
    nodes_.share_with(other.nodes_), other.nodes_.share_with(nodes_);
    leaves_.share_with(other.leaves_), other.leaves_.share_with(leaves_);
  }

 private:
  template <class T>
  T* counted(T* item) {
    item->count.store(1, std::memory_order_relaxed);
    live_bytes_ += static_cast<std::ptrdiff_t>(sizeof(T));
    return item;
  }

  bool alone_;
  FreeList<MapNode> nodes_;
  FreeList<MapLeaf> leaves_;
  std::ptrdiff_t live_bytes_ = 0;
};

}  // namespace helixnav::fastslam
