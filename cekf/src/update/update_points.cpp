// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"
#include "update/innovation.hpp"

namespace helixnav::cekf {

UpdateResult CompressedEkf::update(const PointRows& rows) {
  check_rows(rows);
  if (rows.nu.size() == 0) return {};
  BeforeActivations before = before_activations(false);
  try {
    for (const core::LandmarkId id : rows.ids) activate(id);
    UpdateWorkspace& w = workspace_;
    w.ids = rows.ids;
    w.landmark_of_row.clear();
    gather_involved(w);
    const Eigen::Index m = rows.nu.size();
    w.H.resize(m, 3 + rows.H.cols());
    w.H.set_zero();
    w.H.view().rightCols(rows.H.cols()) = rows.H;
    w.R.resize(m, m);
    w.R.set_zero();
    w.R.view().diagonal().setOnes();
    w.nu.resize(m, 1);
    w.nu.view() = rows.nu;
    const double nis = solve_innovation(w, "update");
    apply_correction(w, "update");
    return {nis, static_cast<int>(m)};
  } catch (...) {
    undo_activations(before);
    throw;
  }
}

void CompressedEkf::check_rows(const PointRows& rows) const {
  std::vector<core::LandmarkId> ids = rows.ids;
  for (const core::LandmarkId id : ids) place_of(id, "update");
  std::sort(ids.begin(), ids.end());
  const bool repeats = std::adjacent_find(ids.begin(), ids.end()) != ids.end();
  if (repeats || rows.H.cols() != 2 * static_cast<Eigen::Index>(rows.ids.size()) || rows.H.rows() != rows.nu.size() ||
      !rows.H.allFinite() || !rows.nu.allFinite()) {
    throw core::PreconditionError("update: rows need a finite m×(2·ids) H, m innovations, and each landmark once");
  }
}

}  // namespace helixnav::cekf
