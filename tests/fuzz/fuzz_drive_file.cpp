// SPDX-License-Identifier: BSD-3-Clause
// A block of a drive.bin, with a matching size and checksum added: something another program may have written. What is read
// must be acceptable to an estimator, and must be the same after being written and read again.
#include <fstream>
#include <iterator>

#include <boost/crc.hpp>

#include "fuzz_input.hpp"
#include "helixnav/runs/drive_file.hpp"

namespace {

using namespace helixnav;

std::string written(const runs::FedDrive& drive) {
  const std::filesystem::path path = fuzz::folder() / "written.bin";
  std::filesystem::remove(path);
  runs::DriveFile file(path.string(), drive.start);
  for (const core::Event& event : drive.events) file.add(event);
  file.finish();
  std::ifstream bytes(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(bytes), {}};
}

void put(std::string& bytes, std::uint32_t value) {
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xffU);
}

std::string with_frame(const std::uint8_t* data, std::size_t size) {
  std::string bytes = written({});
  boost::crc_32_type crc;
  crc.process_bytes(data, size);
  put(bytes, static_cast<std::uint32_t>(size));
  put(bytes, ~static_cast<std::uint32_t>(size));
  put(bytes, crc.checksum());
  return bytes.append(reinterpret_cast<const char*>(data), size);
}

runs::FedDrive read(const std::string& bytes) {
  const fuzz::MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  return runs::read_drive(file.path().string());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = with_frame(data, size);
  fuzz::read_or_refuse([&] {
    core::Recording recording;
    const runs::FedDrive drive = read(bytes);
    recording.events = drive.events;
    fuzz::check_recording(recording);
    const std::string again = written(drive);
    fuzz::require(written(read(again)) == again, "what was written is read otherwise");
  });
  return 0;
}
