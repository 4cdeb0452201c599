// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/compressed_ekf.hpp"
#include "update/innovation.hpp"

namespace helixnav::cekf {

UpdateResult CompressedEkf::position_innovation(const core::AbsoluteFix& fix) const {
  check_fix(fix, "position_innovation");
  UpdateWorkspace w;
  gather_involved(w);
  linearise_fix(fix, w);
  return {solve_innovation(w, "position_innovation"), 2};
}

UpdateResult CompressedEkf::update_position(const core::AbsoluteFix& fix) {
  check_fix(fix, "update_position");
  UpdateWorkspace& w = workspace_;
  w.ids.clear();
  gather_involved(w);
  linearise_fix(fix, w);
  const double nis = solve_innovation(w, "update_position");
  apply_correction(w, "update_position");
  return {nis, 2};
}

}  // namespace helixnav::cekf
