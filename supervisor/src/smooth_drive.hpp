// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drive_log.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"

namespace helixnav::supervisor {

/// What solving the drive as a whole came to.
struct Smoothing {
  bool accepted = false;
  double chi2 = 0.0;   ///< least squares' cost at its solution
  double limit = 0.0;  ///< what it must not exceed
  int poses = 0;
  int iterations = 0;
};

/// Puts the filter where least squares over the whole drive, every observation attributed as it is known now, has its
/// minimum, with the covariance of all measurements linearised there: the drive is filtered once more along the solution.
/// After a closing that turned a part of the map by many degrees the filter is linearised where that part was drawn, and
/// no retraction of its own undoes that (docs/adr/0010-solving-the-drive.md).
/// Not accepted, filter as it was: no convergence, or a minimum that costs more than what the filter has found, which is
/// another one. Landmarks keep their ids.
/// Cost: a few sparse factorisations and the filter's updates of the whole drive; ADR 10 has milliseconds.
/// Test: supervisor/smooth_drive_test.cpp.
Smoothing smooth_drive(cekf::CompressedEkf& filter, const DriveLog& log);

}  // namespace helixnav::supervisor
