// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/association/associate.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::team {

constexpr double rival_variance_factor = 4.0;  ///< on the covariance within which rivals of a match are looked for

/// Revokes matches that may equally be of another landmark, which the scan has not found elsewhere: odds of 20 are required. Which of
/// two landmarks it is makes no difference if the noise given is wider than they are apart. A landmark that nobody has begun is a rival,
/// too: as many as the scan shows, anywhere in its field of view. Rivals are looked for as if all
/// deviations of `joint` were twice as large: after a stretch in which nothing was seen the heading may be off by more than a
/// linear prediction covers, and the true landmark beyond the gate. A match that has rivals by itself stays where the scan as a
/// whole has none: the best joint matching contains it, and is a thousand times as likely as any that shares no pair with it.
/// `look`: the scan with the noise of one look, by which things are told apart; `scan`: with the noise given.
/// Test: team/doubtful_matches_test.cpp.
void leave_doubtful(const core::Scan& scan, const core::Scan& look, const core::JointGaussian& joint,
                    const association::Gates& gates, const association::Options& options,
                    association::Assignment& assignment);

}  // namespace helixnav::team
