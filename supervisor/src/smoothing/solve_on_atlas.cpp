// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/solve_on_atlas.hpp"

namespace helixnav::supervisor {

AtlasSolution solve_on_atlas(const cekf::CompressedEkf& filter, const Tape& tape, DriveMap& map) {
  AtlasSolution solution;
  Smoothing& figures = solution.figures;
  map.take(tape, filter);
  const int before = map.atlas().nodes_redone();
  map.settle();
  figures.limit = map.cost() + slack();
  figures.chi2 = map.atlas().chi2();
  figures.poses = map.atlas().phase_count() + 1;
  figures.iterations = map.atlas().nodes_redone() - before;
  solution.accepted = figures.chi2 <= figures.limit;
  if (solution.accepted) figures.path = map.path();
  return solution;
}

}  // namespace helixnav::supervisor
