// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "helixnav/core/joint_map.hpp"

namespace helixnav::runs {

/// Landmarks in the largest map that is saved with its joint covariance: 64 MB. Others are saved as factors.
inline constexpr std::size_t most_joint_landmarks = 2000;

/// Passes on the bytes of map.bin (docs/run-folder.md) in blocks: version, sizes, pose, landmarks, the lower triangle of the joint
/// covariance or the factors, SHA-256 of everything before. PreconditionError for a map whose parts do not fit together, or
/// a dense one with more landmarks than that; nothing was passed on then.
void put_joint_map(const core::JointMap& map, const std::function<void(std::string_view)>& take);

/// The same in one piece.
std::string joint_map_bytes(const core::JointMap& map);

/// Reads a map.bin. InputError naming the file if it cannot be read, is not a map.bin, is cut short or too long, is of
/// another version, does not match the digest written in it, or does not hold a valid map. O(bytes). Test:
/// runs/joint_map_file_test.cpp (there and back bit for bit; every byte flipped; every length).
core::JointMap read_joint_map(const std::string& path);

}  // namespace helixnav::runs
