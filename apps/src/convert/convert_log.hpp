// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/add_noise.hpp"

namespace helixnav::apps {

/// Formats that convert writes.
enum class GraphFormat { dlr, g2o, isam, gtsam, jsonl };

std::string name_of(GraphFormat format);  ///< as on the command line
std::vector<std::string> format_names();
std::optional<GraphFormat> format_by_name(const std::string& name);
std::optional<GraphFormat> format_by_extension(const std::string& extension);  ///< with its dot

struct Converted {
  std::size_t poses = 0;
  std::size_t landmarks = 0;  ///< of the graph; DLR text: labels
  std::size_t observations = 0;
  int unlabelled_observations = 0;   ///< left out
  int unlocated_landmarks = 0;       ///< left out
  std::size_t times_told_apart = 0;  ///< JSON Lines: events that had no time of their own
  std::vector<logs::AddedNoise> noise;
};

/// Reads `in`, adds the noise and writes `out`, completely or not at all. A g2o graph without noise keeps its start values when
/// written as a graph; all other graphs start from dead reckoning. JSON Lines of the user's own schema need a vehicle.toml,
/// which is written next to them, unless `in` is read by that one. InputError for what cannot be read or represented, and for a
/// different vehicle.toml there unless it is to be overwritten: with that of another sensor the lines would be misread.
/// Test: apps/convert_test.cpp.
Converted convert_log(const std::string& in, const std::string& out, GraphFormat format,
                      const std::vector<logs::Noise>& noises, std::uint64_t seed, bool overwrite);

/// The same for a recording that was read from `in`.
Converted convert_recording(core::Recording recording, const std::string& in, const std::string& out,
                            GraphFormat format, const std::vector<logs::Noise>& noises, std::uint64_t seed,
                            bool overwrite);

/// Counts, and a line for each noise with its measured standard deviation.
std::string text_of(const Converted& converted);

}  // namespace helixnav::apps
