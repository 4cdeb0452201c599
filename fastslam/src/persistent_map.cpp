// SPDX-License-Identifier: BSD-3-Clause
#include "persistent_map.hpp"

#include <algorithm>

namespace helixnav::fastslam {
namespace {

std::atomic<std::uint32_t>& count_of(void* at, std::uint32_t level) {
  return level == 0 ? static_cast<MapLeaf*>(at)->count : static_cast<MapNode*>(at)->count;
}

/// One pointer fewer to what is `level` levels above the leaves.
void release(void* at, std::uint32_t level, NodePool& pool) {
  if (at == nullptr || !pool.decrement(count_of(at, level))) return;
  if (level == 0) {
    pool.put(static_cast<MapLeaf*>(at));
    return;
  }
  auto* node = static_cast<MapNode*>(at);
  for (void* child : node->child) release(child, level - 1, pool);
  pool.put(node);
}

/// The node that `at` points to, made this map's own.
MapNode& own_node(void*& at, std::uint32_t level, NodePool& pool) {
  auto* node = static_cast<MapNode*>(at);
  if (node != nullptr && node->count.load(std::memory_order_acquire) == 1) return *node;
  MapNode* own = pool.take_node();
  if (node == nullptr) {
    std::fill(std::begin(own->child), std::end(own->child), nullptr);
  } else {
    std::copy(std::begin(node->child), std::end(node->child), std::begin(own->child));
    for (void* child : own->child) {
      if (child != nullptr) pool.increment(count_of(child, level - 1));
    }
    release(node, level, pool);
  }
  at = own;
  return *own;
}

MapLeaf& own_leaf(void*& at, NodePool& pool) {
  auto* leaf = static_cast<MapLeaf*>(at);
  if (leaf != nullptr && leaf->count.load(std::memory_order_acquire) == 1) return *leaf;
  MapLeaf* own = pool.take_leaf();
  own->present = 0;
  if (leaf != nullptr) {
    own->present = leaf->present;
    std::copy(std::begin(leaf->landmark), std::end(leaf->landmark), std::begin(own->landmark));
    release(leaf, 0, pool);
  }
  at = own;
  return *own;
}

}  // namespace

void PersistentMap::grow_to(LineageId id, NodePool& pool) {
  while (!covers(id)) {
    ++levels_;
    if (root_ == nullptr) continue;
    MapNode* above = pool.take_node();
    std::fill(std::begin(above->child), std::end(above->child), nullptr);
    above->child[0] = root_;
    root_ = above;
  }
}

LandmarkRecord& PersistentMap::write(LineageId id, NodePool& pool) {
  grow_to(id, pool);
  void** at = &root_;
  for (std::uint32_t level = levels_; level > 0; --level) at = &own_node(*at, level, pool).child[slot(id, level)];
  MapLeaf& leaf = own_leaf(*at, pool);
  const std::uint32_t bit = 1U << (id & 7U);
  if ((leaf.present & bit) == 0) ++size_;
  leaf.present |= bit;
  return leaf.landmark[id & 7U];
}

void PersistentMap::erase(LineageId id, NodePool& pool) {
  if (find(id) == nullptr) return;
  void** at = &root_;
  for (std::uint32_t level = levels_; level > 0; --level) at = &own_node(*at, level, pool).child[slot(id, level)];
  MapLeaf& leaf = own_leaf(*at, pool);
  leaf.present &= ~(1U << (id & 7U));
  --size_;
  if (leaf.present != 0) return;
  release(&leaf, 0, pool);
  *at = nullptr;
}

void PersistentMap::share(const PersistentMap& other, NodePool& pool) {
  if (other.root_ != nullptr) pool.increment(count_of(other.root_, other.levels_));
  release(root_, levels_, pool);
  root_ = other.root_;
  levels_ = other.levels_;
  size_ = other.size_;
}

void PersistentMap::clear(NodePool& pool) {
  release(root_, levels_, pool);
  root_ = nullptr;
  levels_ = 0;
  size_ = 0;
}

}  // namespace helixnav::fastslam
