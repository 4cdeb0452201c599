// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_manifest.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

#include <openssl/evp.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::runs {

namespace {

std::string hexadecimal(const unsigned char* bytes, unsigned count) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < count; ++i) {
    text += digits[bytes[i] >> 4U];
    text += digits[bytes[i] & 15U];
  }
  return text;
}

std::string quoted_for_shell(const std::string& word) {
  static constexpr char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

bool starts_with(const std::string& word, const char* beginning) { return word.rfind(beginning, 0) == 0; }

}  // namespace

std::string sha256_of_file(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_character_file(path, unknown)) {
    throw core::InputError(path + ": expected a file, found a device, which may have no end");
  }
  std::ifstream file(path, std::ios::binary);
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  bool fine = file.good() && context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  std::vector<char> block(65536);
  while (fine && !file.eof()) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    fine = !file.bad() && EVP_DigestUpdate(context.get(), block.data(), static_cast<std::size_t>(file.gcount())) == 1;
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  if (!fine || EVP_DigestFinal_ex(context.get(), digest.data(), &length) != 1) {
    throw core::InputError(path + ": cannot read: " + std::strerror(errno));
  }
  return hexadecimal(digest.data(), length);
}

std::string sha256_of_bytes(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
    throw core::NumericalError("SHA-256 is not to be had");
  }
  return hexadecimal(digest.data(), length);
}

std::string command_text(const std::vector<std::string>& arguments) {
  std::string text;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    if (i == 0) {
      text = quoted_for_shell(word.substr(word.find_last_of('/') + 1));
    } else if (word == "--out" || word == "-o") {
      ++i;
    } else if (word != "--overwrite" && !starts_with(word, "--out=")) {
      text += ' ' + quoted_for_shell(word);
    }
  }
  return text;
}

}  // namespace helixnav::runs
