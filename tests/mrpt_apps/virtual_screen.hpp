// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "program.hpp"

namespace helixnav::apps {

/// An X server without a screen, whose picture is kept in a file. It ends with this process and not before: wxWidgets
/// keeps its connection to the end, and exits if that is cut.
class VirtualScreen {
 public:
  explicit VirtualScreen(const std::filesystem::path& folder) : image_(folder / "Xvfb_screen0") {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    if (fork() == 0) {
      prctl(PR_SET_PDEATHSIG, SIGTERM);
      const std::string number = std::to_string(ends[1]);
      execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1024x768x24", "-fbdir", folder.c_str(),
             "-nolisten", "tcp", static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    char byte = 0;
    while (read(ends[0], &byte, 1) == 1 && byte != '\n') display_ += byte;
    close(ends[0]);
  }
  /// ":N", or ":" when there is no server.
  std::string display() const { return ":" + display_; }

  /// Pixels as blue as landmarks, in the XWD file that the server keeps.
  int blue_pixels() const {
    const std::string xwd = text_of(image_);
    const auto word = [&xwd](std::size_t i) {
      std::uint32_t value = 0;
      for (std::size_t byte = 0; byte < 4; ++byte) value = value << 8U | static_cast<unsigned char>(xwd[4 * i + byte]);
      return static_cast<std::size_t>(value);
    };
    if (xwd.size() < 100) return 0;
    const std::size_t pixels = word(0) + 12 * word(19);
    int count = 0;
    for (std::size_t i = pixels; i + 4 <= xwd.size(); i += 4) {
      const auto blue = static_cast<unsigned char>(xwd[i]);
      const auto red = static_cast<unsigned char>(xwd[i + 2]);
      if (blue > red + 60 && blue > 120) ++count;
    }
    return count;
  }

 private:
  std::filesystem::path image_;
  std::string display_;
};

}  // namespace helixnav::apps
