// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <sys/types.h>

#include "temporary_folder.hpp"

namespace helixnav::apps {

/// How a run of the program ended.
struct Outcome {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;      ///< that ended it; 0: none
  std::string out;     ///< all of stdout
  std::string err;     ///< all of stderr
};

/// The program under way, without a terminal. Killed when it is still running at the end of this object's life.
class Program {
 public:
  /// `prepare` is called in the new process, its outputs redirected, before the program is there.
  explicit Program(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void send(int signal) const;
  bool catches(int signal) const;  ///< it has got so far as to install its handler
  Outcome wait();

 private:
  testing::TemporaryFolder outputs_;
  pid_t process_ = -1;
};

inline Outcome run(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {}) {
  return Program(arguments, prepare).wait();
}

std::string text_of(const std::filesystem::path& file);
std::set<std::string> names_in(const std::filesystem::path& folder);

/// Lines that have their end.
std::size_t complete_lines(const std::filesystem::path& file);

}  // namespace helixnav::apps
