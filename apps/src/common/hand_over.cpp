// SPDX-License-Identifier: BSD-3-Clause
#include "hand_over.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {

void hand_over(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  std::fflush(nullptr);
  std::error_code unknown;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
  if (!unknown) execv((here / program).c_str(), argv.data());
  execvp(program.c_str(), argv.data());
  throw core::InputError("rawlogs are the business of " + program +
                         ", which stands neither beside this program nor on PATH; it is built where MRPT is");
}

}  // namespace helixnav::apps
