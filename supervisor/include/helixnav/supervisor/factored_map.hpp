// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::supervisor {

/// What a map that holds factors has besides: places and covariances of the landmarks as its drive has them, which takes
/// most of the time, or as they are listed. In the latter case the factors of a drive that its filter holds as a whole are not solved.
enum class FactoredMap { whole, factors_alone };

}  // namespace helixnav::supervisor
