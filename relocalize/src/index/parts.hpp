// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "helixnav/relocalize/map_index.hpp"
#include "index/looked_ground.hpp"
#include "index/node.hpp"
#include "index/tile_grid.hpp"
#include "index/triangle_bins.hpp"

namespace helixnav::relocalize {

/// How often the map's landmarks have which kind and size: what chance would show. Sizes are summed in tenths of a
/// millimetre, in integers, so that removal undoes insertion exactly.
struct Appearances {
  std::map<int, std::int64_t> kinds;
  std::int64_t with_kind = 0;
  std::int64_t with_size = 0;
  std::int64_t sum = 0;
  std::int64_t sum_of_squares = 0;

  void count(const Landmark& landmark, int sign);
  double kind_share(int kind) const;  ///< of a landmark with a kind; never 0
  double size_mean_m() const;
  double size_variance_m2() const;
};

/// Number of triangles by sides in fixed cells of a sixteenth of the reach: which triangle is rare must not depend on how
/// the bins happen to be cut.
class Rarity {
 public:
  explicit Rarity(float reach_m) : per_metre_(side / reach_m), counts_(side * side * side) {}
  void count(const Sides& sides_m, int sign) { counts_[cell(sides_m)] += static_cast<std::uint32_t>(sign); }
  std::uint32_t of(const Sides& sides_m) const { return counts_[cell(sides_m)]; }
  std::size_t memory_bytes() const { return counts_.capacity() * sizeof(std::uint32_t); }

 private:
  static constexpr int side = 16;
  std::size_t cell(const Sides& s) const {
    const auto at = [&](float v) { return std::min(side - 1, static_cast<int>(v * per_metre_)); };
    return static_cast<std::size_t>((at(s[0]) * side + at(s[1])) * side + at(s[2]));
  }
  float per_metre_;
  std::vector<std::uint32_t> counts_;
};

/// A neighbour in search order: by distance, then by id.
struct Neighbour {
  float d2_m2;
  core::LandmarkId id;
  Slot slot;
  bool operator<(const Neighbour& other) const { return d2_m2 != other.d2_m2 ? d2_m2 < other.d2_m2 : id < other.id; }
};

/// A list of neighbours that becomes another at one place.
struct Exchange {
  Slot of;
  int place;
  Slot before;  ///< no_slot when the place was empty
  Slot after;   ///< no_slot when it becomes so
};

/// Kind and size of a landmark; a negative σ says that the size is unknown.
struct Trait {
  std::optional<int> kind;
  float size_m = 0.0F;
  float size_sigma_m = -1.0F;
};

struct MapIndex::Parts {
  explicit Parts(const IndexOptions& given);

  IndexOptions options;
  float reach_m;
  float noise_m;
  bool placed = false;  ///< the origin is set, by the first landmark or disc
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
  Nodes nodes;
  Details details;
  SparsePages<Slot> slots{no_slot};    ///< by id
  SparsePages<Trait> traits{Trait()};  ///< by slot
  Appearances appearances;
  TileGrid grid;
  LookedGround looked;
  TriangleBins bins;
  Rarity rarity;
  std::size_t count = 0;
  Slot free_slot = no_slot;

  float least_side_m() const { return 6.0F * noise_m; }
  float side_tolerance_m() const { return 2.5F * 1.41421356F * noise_m; }
  float far_pair_m() const { return 6.0F * noise_m; }  ///< farther apart, two landmarks are never a pair

  Slot slot_of(core::LandmarkId id) const { return id < 0 ? no_slot : slots[static_cast<std::size_t>(id)]; }
  void check(const Landmark& landmark) const;
  bool has_room_at(const Eigen::Vector2d& point_m) const;
  void place_origin(const Eigen::Vector2d& near_m);

  Slot add_node(const Landmark& landmark);
  void drop_node(Slot slot);

  /// The `wanted` nearest within reach, without `self`.
  std::vector<Neighbour> nearest(Slot self, std::size_t wanted) const;
  void link(Slot slot);
  void unlink(Slot slot);
  void apply(const std::vector<Exchange>& exchanges);
  void measure_farthest(Slot slot);
  void store_all_triangles();
  void refit();
};

}  // namespace helixnav::relocalize
