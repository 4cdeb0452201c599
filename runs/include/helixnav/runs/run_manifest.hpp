// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace helixnav::runs {

/// An input of a run: its name as the user gave it and the SHA-256 of its bytes (64 hexadecimal digits).
struct InputFile {
  std::string name;
  std::string sha256;
};

/// What produced a run: enough to reproduce it. Contains neither time of day nor host, so that the same command writes
/// the same bytes.
struct RunManifest {
  std::string version;    ///< of HelixNav, such as 0.1.0
  std::string commit;     ///< of the source tree; empty when unknown
  std::string command;    ///< see command_text
  std::string recording;  ///< Recording::name; title of the report
  std::string config;     ///< every key in force; JSON is embedded as JSON, other text as one string
  std::uint64_t seed = 0;
  std::vector<InputFile> inputs;
};

/// The text of manifest.json. Bytes that are not UTF-8 (from a file name, say) become U+FFFD.
std::string manifest_json(const RunManifest& manifest);

/// SHA-256 of the file's bytes in lower-case hexadecimal (OpenSSL). Cost: one pass in blocks of 64 KiB. InputError when
/// the file cannot be read. Test: runs/run_manifest_test.cpp (published digests).
std::string sha256_of_file(const std::string& path);
std::string sha256_of_bytes(std::string_view bytes);

/// `arguments` (program first, its path dropped) as one line that a POSIX shell reads back as the same words, without
/// `--out X`, `--out=X`, `-o X` and `--overwrite`: where a run is stored does not change what it is. Test:
/// runs/run_manifest_test.cpp.
std::string command_text(const std::vector<std::string>& arguments);

}  // namespace helixnav::runs
