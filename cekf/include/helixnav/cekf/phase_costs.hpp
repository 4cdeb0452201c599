// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::cekf {

/// Cost of the latest phases with passive landmarks, in multiply-adds and as a polynomial in the number D of mapped
/// coordinates, so that it can be compared with the cost of updating a map that is entirely active: D² for each row of
/// an observation. A phase with n active coordinates and q weights costs (n + q)² per row and, when it ends with t of
/// its weights reached, 2q(n + t) per mapped coordinate and t per pair of them (docs/cekf.md). Each phase counts half
/// as much as the next one. Test: cekf/law_test.cpp.
struct PhaseCosts {
  double rows = 0.0;
  double updates = 0.0;
  double linear = 0.0;
  double quadratic = 0.0;

  void note(double phase_rows, double n, double q, double t) {
    rows = 0.5 * rows + phase_rows;
    updates = 0.5 * updates + phase_rows * (n + q) * (n + q);
    linear = 0.5 * linear + 2.0 * q * (n + t);
    quadratic = 0.5 * quadratic + t;
  }

  /// Whether the same rows would have cost less had all landmarks been active. False as long as nothing is known.
  bool is_whole_cheaper(double D) const {
    return rows > 0.0 && rows * D * D < updates + linear * D + quadratic * D * D;
  }
};

}  // namespace helixnav::cekf
