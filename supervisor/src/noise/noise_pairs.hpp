// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "slip/relative_geometry.hpp"

namespace helixnav::supervisor {

/// An observed point and the only landmark that it can be, however large the noise may be.
struct NoisePair {
  SeenPoint seen;
  core::LandmarkId landmark;
  double limit_m;  ///< had they been this far apart, they would not be a pair
};

/// Whether its distance is a fair sample of the noise: 2.2 standard deviations of it, S_m2 as believed, are within its limit. In a row
/// of posts only small distances make pairs, and would say that the noise is small.
bool is_fair(const NoisePair& pair, const Eigen::Matrix2d& S_m2);

/// Pairs four times nearer to each other than either is to the next of its kind. No gate is involved: if the assumed
/// noise is far too small, a gate admits only what happens to fit. O(n²) in the points seen, at most 24, nearest to the
/// sensor first. Test: supervisor/noise/noise_pairs_test.cpp.
std::vector<NoisePair> noise_pairs(const cekf::CompressedEkf& filter, const core::Scan& scan);

/// The side from which each landmark was seen when its error last counted as independent. Landmarks out of view for a
/// while are forgotten: O(landmarks in view) bytes. Test: supervisor/noise/noise_pairs_test.cpp.
class SidesSeen {
 public:
  void next_scan();

  /// True if the landmark is seen from a side half a radian or more from the last that counted; this one then counts.
  bool is_new_side(core::LandmarkId id, double bearing_to_vehicle_rad);

 private:
  struct Side {
    double bearing_rad;
    long scan;
  };

  std::map<core::LandmarkId, Side> sides_;
  long scan_ = 0;
};

}  // namespace helixnav::supervisor
