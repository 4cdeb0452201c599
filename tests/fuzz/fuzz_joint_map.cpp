// SPDX-License-Identifier: BSD-3-Clause
// A map.bin with a matching digest added: something another program may have written. What is read has the same bytes
// when it is written, and a session can continue in it.
#include <openssl/evp.h>

#include <array>

#include "fuzz_input.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace {

std::string with_digest(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  EVP_Digest(data, size, digest.data(), &length, EVP_sha256(), nullptr);
  return bytes.append(reinterpret_cast<const char*>(digest.data()), length);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helixnav;
  const std::string bytes = with_digest(data, size);
  const fuzz::MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  fuzz::read_or_refuse([&] {
    const core::JointMap map = runs::read_joint_map(file.path().string());
    fuzz::require(runs::joint_map_bytes(map) == bytes, "what was read is written otherwise");
    supervisor::Navigator navigator = supervisor::Navigator::go_on_in(map);
    fuzz::require(navigator.map().size() == map.joint.ids.size(), "as many landmarks as in the file");
  });
  return 0;
}
