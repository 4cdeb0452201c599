// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::cekf {

/// What the latest phases with passive landmarks have cost, in multiply-adds and as a polynomial of the coordinates D that
/// are mapped, so that it can be held against an update of a map of which all is active: D² for each row of an observation. A phase with n
/// coordinates and q weights active costs (n + q)² a row, and when it ends, t of its weights reached, 2q(n + t) a
/// coordinate mapped and t a pair of them (docs/cekf.md). Each phase counts half as much as the next one.
/// Test: cekf/law_test.cpp.
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

  /// Whether the same rows would have cost less, had all been active. False as long as nothing is known.
  bool is_whole_cheaper(double D) const {
    return rows > 0.0 && rows * D * D < updates + linear * D + quadratic * D * D;
  }
};

}  // namespace helixnav::cekf
