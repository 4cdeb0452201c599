// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace helixnav::core {

/// The user's failure: a file, an option or a configuration value that cannot be used. Raised when input is loaded,
/// never in mid-run. The message names the key or the file with line (or byte), the value found and what was expected.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller's failure: a call whose arguments break a documented precondition (an unknown or removed landmark id, a
/// covariance that is not symmetric positive definite, NaN in an observation). The object called is left as it was.
class PreconditionError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Broken mathematics: an innovation covariance that is not positive definite, NaN in a state. The message names the
/// step and the landmark ids involved. The object called is left as it was before the call.
class NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace helixnav::core
