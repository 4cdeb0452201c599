// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {

CompressedEkf::CompressedEkf(const core::PoseGaussian& start, const FilterOptions& options)
    : options_(options), keep_since_(std::numeric_limits<long>::max()) {
  if (!start.mean.vector().allFinite() || !core::is_symmetric_positive_semidefinite(start.covariance)) {
    throw core::PreconditionError("CompressedEkf: the start must be finite with a positive semidefinite covariance");
  }
  if (!(options.cell_side_m > 0.0) || !(options.hysteresis_m >= 0.0) || options.max_active_landmarks < 1) {
    throw core::PreconditionError(
        "CompressedEkf: options need cell_side_m > 0, hysteresis_m >= 0, max_active_landmarks >= 1");
  }
  active_.pose = start.mean;
  active_.P.resize(3, 3);
  active_.P.view() = 0.5 * (start.covariance + start.covariance.transpose());
  active_.A.resize(0, 3);
  Phase first;
  first.start_m = start.mean.position_m();
  first.cell = cell_of(first.start_m);
  open_phase(std::move(first), Eigen::MatrixXd(0, 3), {});
}

}  // namespace helixnav::cekf
