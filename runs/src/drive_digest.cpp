// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/drive_digest.hpp"

#include <algorithm>
#include <variant>

#include "helixnav/runs/run_manifest.hpp"
#include "little_endian.hpp"

namespace helixnav::runs {
namespace {

constexpr std::size_t enough = 16;

}  // namespace

void DriveDigest::add(const core::Scan& scan) {
  if (observations_ >= enough || scan.observations.empty()) return;
  put_unsigned(bytes_, static_cast<std::uint64_t>(scan.t_ns));
  for (const core::Observation& observation : scan.observations) {
    put_unsigned(bytes_, static_cast<std::uint32_t>(observation.kind));
    for (Eigen::Index row = 0; row < observation.z.size(); ++row) put(bytes_, observation.z[row]);
  }
  observations_ += scan.observations.size();
}

std::string DriveDigest::text() const { return observations_ < enough ? std::string() : sha256_of_bytes(bytes_); }

std::vector<std::string> drives_of(const std::vector<core::Event>& events) {
  DriveDigest digest;
  for (const core::Event& event : events) {
    if (const auto* scan = std::get_if<core::Scan>(&event)) digest.add(*scan);
    if (const std::string text = digest.text(); !text.empty()) return {text};
  }
  return {};
}

std::vector<std::string> united_drives(std::vector<std::string> drives, const std::vector<std::string>& others) {
  drives.insert(drives.end(), others.begin(), others.end());
  std::sort(drives.begin(), drives.end());
  drives.erase(std::unique(drives.begin(), drives.end()), drives.end());
  return drives;
}

}  // namespace helixnav::runs
