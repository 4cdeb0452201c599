// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/relative_gaussian.hpp"

namespace helixnav::atlas {

using core::RelativeGaussian;

}  // namespace helixnav::atlas
