// SPDX-License-Identifier: BSD-3-Clause
// Small files that claim to be large.
#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "input_error.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

namespace fs = std::filesystem;

std::string word32(std::size_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}

std::string element(std::size_t type, const std::string& content) {
  std::string padded = content;
  padded.resize((content.size() + 7) / 8 * 8, '\0');
  return word32(type) + word32(content.size()) + padded;
}

/// A matrix element of MATLAB's version 5: flags, dimensions, name, contents.
std::string matrix(std::size_t array_class, std::size_t rows, std::size_t columns, const std::string& name,
                   const std::string& content) {
  return element(14, element(6, word32(array_class) + word32(0)) + element(5, word32(rows) + word32(columns)) +
                         element(1, name) + content);
}

std::string nested_cells(int depth) {
  std::string inner = matrix(6, 1, 1, "", element(9, std::string(8, '\0')));
  for (int level = 0; level < depth; ++level) inner = matrix(1, 1, 1, level + 1 == depth ? "cells" : "", inner);
  return inner;
}

std::string compressed(const std::string& bytes) {
  uLongf length = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(length, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
           static_cast<uLong>(bytes.size()));
  packed.resize(length);
  return word32(15) + word32(packed.size()) + packed;
}

std::string mat_file(const std::string& elements) {
  std::string header = "MATLAB 5.0 MAT-file";
  header.resize(124, ' ');
  return header + std::string("\x00\x01IM", 4) + elements;
}

std::string error_of(const std::string& elements) {
  const testing::TemporaryFolder folder;
  const fs::path path = folder.write("hostile.mat", mat_file(elements));
  return testing::input_error_of([&] { read_vicpark_clean(path); });
}

TEST(HostileMatlabFile, CellsThatNestAsInGoodFilesAreRead) {
  for (const int depth : {1, 3, 7}) {
    EXPECT_NE(error_of(nested_cells(depth)).find("expected a variable VicPark_clean_data, found cells"),
              std::string::npos)
        << error_of(nested_cells(depth));
    EXPECT_NE(error_of(compressed(nested_cells(depth))).find("found cells"), std::string::npos);
  }
}

TEST(HostileMatlabFile, CellsThatNestDeeperThanTheStackAreRefused) {
  const std::string deep = nested_cells(2000);
  for (const std::string& elements : {deep, compressed(deep)}) {
    EXPECT_NE(error_of(elements).find("hostile.mat: byte 128: expected cells and structures at most 8 deep"),
              std::string::npos)
        << error_of(elements);
  }
}

TEST(HostileMatlabFile, MatricesBeyondAllMeasureAreRefused) {
  const std::string huge = matrix(6, 400'000'000, 12, "VicPark_clean_data", element(9, std::string(96, '\0')));
  for (const std::string& elements : {huge, compressed(huge)}) {
    EXPECT_NE(error_of(elements).find("expected at most 20 million elements, found 400000000 by 12"), std::string::npos)
        << error_of(elements);
  }
}

/// matio allocates them all before it reads the first: 12 GB for 112 bytes.
TEST(HostileMatlabFile, MoreCellsThanThereAreBytesForAreRefused) {
  const std::string cells = matrix(1, 1, 0x5b000001, "cells", matrix(6, 1, 1, "", element(9, std::string(8, '\0'))));
  const std::string fields =
      matrix(2, 1, 1000, "cells", word32(4 << 16 | 5) + word32(1) + element(1, std::string(100'000, 'a')));
  for (const std::string& elements : {cells, compressed(cells), fields, compressed(fields)}) {
    EXPECT_NE(error_of(elements).find("hostile.mat: byte 128: expected no more cells and fields than there are bytes"),
              std::string::npos)
        << error_of(elements);
  }
}

TEST(HostileMatlabFile, MoreDimensionsThanAnyMatrixHasAreRefused) {
  std::string matrix_of_many = matrix(6, 1, 1, "VicPark_clean_data", element(9, std::string(8, '\0')));
  matrix_of_many.replace(28, 4, word32(0xac000008));  // bytes of the dimensions
  for (const std::string& elements : {matrix_of_many, compressed(matrix_of_many)}) {
    EXPECT_NE(error_of(elements).find("hostile.mat: byte 128: expected at most 32 dimensions"), std::string::npos)
        << error_of(elements);
  }
}

/// matio takes eight bytes of flags whatever length they state, and would find different dimensions after them.
TEST(HostileMatlabFile, FlagsOfAnotherLengthAreRefused) {
  for (const std::uint32_t length : {0u, 16u, 0x80000u}) {
    std::string other_flags = matrix(6, 1, 1, "VicPark_clean_data", element(9, std::string(8, '\0')));
    other_flags.replace(12, 4, word32(length));
    for (const std::string& elements : {other_flags, compressed(other_flags)}) {
      EXPECT_NE(error_of(elements).find("hostile.mat: byte 128: expected array flags of 8 bytes"), std::string::npos)
          << error_of(elements);
    }
  }
}

TEST(HostileMatlabFile, ANameAsLongAsTheFileIsNotIsRefused) {
  std::string long_name = matrix(6, 1, 1, "VicPark_clean_data", element(9, std::string(8, '\0')));
  long_name.replace(44, 4, word32(0xa0000001));  // bytes of the name
  for (const std::string& elements : {long_name, compressed(long_name)}) {
    EXPECT_NE(error_of(elements).find("hostile.mat: byte 128: expected a name of at most 1024 bytes"),
              std::string::npos)
        << error_of(elements);
  }
}

/// 600 MiB of line ends in a 0.6 MiB zip.
TEST(HostileZip, ThatHoldsMoreThanAnyLogIsRefused) {
  const testing::TemporaryFolder folder;
  const fs::path path = folder.path() / "bomb.zip";
  archive* zip = archive_write_new();
  archive_write_set_format_zip(zip);
  archive_write_open_filename(zip, path.c_str());
  archive_entry* entry = archive_entry_new();
  archive_entry_set_pathname(entry, "DRS.txt");
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_entry_set_perm(entry, 0644);
  archive_write_header(zip, entry);
  const std::string block(1 << 20, '\n');
  for (int i = 0; i < 600; ++i) archive_write_data(zip, block.data(), block.size());
  archive_entry_free(entry);
  archive_write_free(zip);
  EXPECT_LT(fs::file_size(path), 2u << 20);
  const std::string message = testing::input_error_of([&] { read_acfr_ascii(path); });
  EXPECT_NE(message.find("bomb.zip: expected at most 512 MiB in DRS.txt, found more"), std::string::npos) << message;
}

}  // namespace
}  // namespace helixnav::logs
