// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/solve_on_atlas.hpp"

#include <vector>

namespace helixnav::supervisor {

Smoothing solve_on_atlas(const cekf::CompressedEkf& filter, const Tape& tape, DriveMap& map) {
  Smoothing result;
  map.take(tape, filter);
  const int before = map.atlas().nodes_redone();
  map.settle();
  const atlas::Atlas& atlas = map.atlas();
  result.limit = map.cost() + slack();
  result.chi2 = atlas.chi2();
  result.poses = atlas.phase_count() + 1;
  result.iterations = atlas.nodes_redone() - before;
  if (!(result.chi2 <= result.limit)) return result;
  result.solved.emplace(atlas.joint(filter.landmarks()), filter.next_name(), filter.options());
  result.path = map.path();
  return result;
}

}  // namespace helixnav::supervisor
