// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace helixnav::apps {

struct Campaign;

/// Drives one seed, judges it and returns its line of runs.jsonl (docs/campaign.md), without the newline. A run that
/// broke down numerically is a line, too: verdict "failed", with the message. Wall-clock figures are under "wall".
std::string run_and_judge(const Campaign& campaign, std::uint64_t seed);

}  // namespace helixnav::apps
