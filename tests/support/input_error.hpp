// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/errors.hpp"

namespace helixnav::testing {

/// The message of the core::InputError that `action` throws; "nothing thrown" when it throws none.
template <class Action>
std::string input_error_of(Action&& action) {
  try {
    action();
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

}  // namespace helixnav::testing
