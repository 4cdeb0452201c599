// SPDX-License-Identifier: BSD-3-Clause
// JSON Lines as they arrive, with the vehicle of the stream's tests: an unusable line is refused, and nothing ends it.
#include "fuzz_input.hpp"
#include "helixnav/logs/own_stream.hpp"

namespace {

using namespace helixnav;

constexpr const char* vehicle_text =
    "[odometry]\nwheelbase_m = 1.5\ntrack_m = 0.8\nsigma_along_m_per_sqrt_m = 0.02\nsigma_v_mps = 0.1\n"
    "sigma_heading_deg_per_sqrt_m = 0.5\n"
    "[[sensor]]\nname = \"near\"\nreach_m = 12\nview_deg = [-180, 180]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n"
    "[[sensor]]\nname = \"far\"\nx_m = 0.3\nreach_m = 40\nview_deg = [-90, 90]\nsigma_range_m = 0.1\n"
    "sigma_bearing_deg = 0.3\ndelay_s = 0.125\nclass_error = 0.1\nsigma_size_m = 0.02\n";

/// Events of all lines, in time order across the calls.
class Received {
 public:
  void take(logs::StreamedEvents next) {
    fuzz::require(next.recording.labels.empty() || next.recording.labels.size() == next.lines.size(),
                  "as many labels as scans");
    for (core::Event& event : next.recording.events) all_.events.push_back(std::move(event));
    for (auto& labels : next.recording.labels) all_.labels.push_back(std::move(labels));
    for (const logs::RefusedLine& refused : next.refused) fuzz::require(!refused.why.empty(), "refused without a word");
  }
  const core::Recording& all() const { return all_; }

 private:
  core::Recording all_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const logs::Vehicle vehicle = logs::read_vehicle_text(vehicle_text, "vehicle");
  if (size == 0) return 0;
  logs::OwnStream stream(vehicle, (data[0] & 1) != 0);
  std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  Received received;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    received.take(stream.take(rest.substr(0, end), number));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  received.take(stream.finish());
  fuzz::check_recording(received.all());
  return 0;
}
