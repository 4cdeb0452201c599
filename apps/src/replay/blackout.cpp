// SPDX-License-Identifier: BSD-3-Clause
#include "blackout.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <variant>

#include <CLI/CLI.hpp>

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {
namespace {

double seconds(core::Nanoseconds t_ns) { return 1e-9 * static_cast<double>(t_ns); }

std::string text_of(double time_s) {
  std::ostringstream text;
  text.precision(15);
  text << time_s;
  return text.str();
}

std::vector<double> scan_times_s(const core::Recording& recording) {
  std::vector<double> times_s;
  for (const core::Event& event : recording.events) {
    if (std::holds_alternative<core::Scan>(event)) times_s.push_back(seconds(core::time_of(event)));
  }
  return times_s;
}

void mark(const Blackout& blackout, const std::vector<double>& times_s, const std::string& log,
          std::vector<bool>& withheld) {
  const auto begin = std::lower_bound(times_s.begin(), times_s.end(), blackout.begin_s);
  const auto end = std::lower_bound(begin, times_s.end(), blackout.end_s);
  if (begin == end) {
    const std::string lasts =
        times_s.empty() ? "which has no scans"
                        : "whose scans last from " + text_of(times_s.front()) + " to " + text_of(times_s.back()) + " s";
    throw core::InputError("--blackout " + text_of(blackout.begin_s) + ":" + text_of(blackout.end_s) +
                           ": expected times of " + log + ", " + lasts + "; found no scan in between");
  }
  std::fill(withheld.begin() + (begin - times_s.begin()), withheld.begin() + (end - times_s.begin()), true);
}

}  // namespace

Blackout blackout_from(const std::string& word, std::string& objection) {
  Blackout blackout;
  const std::size_t colon = word.find(':');
  const bool numbers = colon != std::string::npos &&
                       CLI::detail::lexical_cast(word.substr(0, colon), blackout.begin_s) &&
                       CLI::detail::lexical_cast(word.substr(colon + 1), blackout.end_s);
  if (!numbers || !std::isfinite(blackout.begin_s) || !std::isfinite(blackout.end_s)) {
    objection = "expected T0:T1, two times in seconds, found '" + word + "'";
  } else if (blackout.end_s <= blackout.begin_s) {
    objection = "expected T0 before T1, found '" + word + "'";
  }
  return blackout;
}

std::vector<bool> withhold(core::Recording& recording, const std::vector<Blackout>& blackouts) {
  const std::vector<double> times_s = scan_times_s(recording);
  std::vector<bool> withheld(times_s.size(), false);
  for (const Blackout& blackout : blackouts) mark(blackout, times_s, recording.name, withheld);
  std::size_t scan = 0;
  for (core::Event& event : recording.events) {
    auto* blind = std::get_if<core::Scan>(&event);
    if (blind == nullptr) continue;
    if (withheld[scan]) {
      blind->observations.clear();
      if (!recording.labels.empty()) recording.labels[scan].clear();
    }
    ++scan;
  }
  auto& shared = recording.shared_observations;
  shared.erase(std::remove_if(shared.begin(), shared.end(), [&](const auto& s) { return withheld[s.scan]; }),
               shared.end());
  return withheld;
}

}  // namespace helixnav::apps
