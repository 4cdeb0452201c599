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
  int signal = 0;      ///< the signal that ended it; 0: none
  std::string out;     ///< all of stdout
  std::string err;     ///< all of stderr
};

/// The running program, without a terminal. Killed if it is still running when this object is destroyed.
class Program {
 public:
  /// `prepare` is called in the new process, with its outputs redirected, before the program is loaded.
  explicit Program(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void send(int signal) const;
  bool catches(int signal) const;  ///< it has got as far as installing its handler
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

/// Complete lines only.
std::size_t complete_lines(const std::filesystem::path& file);

}  // namespace helixnav::apps
