// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "matrices/move_rows.hpp"

namespace helixnav::cekf {

/// What closing a phase changes in the filter before the next one is in place.
struct CompressedEkf::BeforeSwitch {
  std::vector<int> slots;
  std::vector<int> free_slots;
  long last_phase = 0;
  std::size_t taken = 0;
  std::shared_ptr<ReservedMatrix> columns;  ///< null, or what was the covariance of the active part
  Eigen::VectorXd column;                   ///< room for one of them
  std::vector<MovedRows> moves;             ///< what has made them of it
};

}  // namespace helixnav::cekf
