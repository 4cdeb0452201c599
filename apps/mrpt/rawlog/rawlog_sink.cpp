// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog/rawlog_sink.hpp"

#include <filesystem>
#include <system_error>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/serialization/CArchive.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {

struct RawlogSink::File {
  explicit File(const std::string& name) : path(name), unfinished(name + ".part") {
    if (!gz.open(unfinished)) throw core::InputError(path + ": cannot be written");
    archive = mrpt::serialization::archiveUniquePtrFrom<mrpt::io::CStream>(gz);
  }

  std::string path;
  std::string unfinished;
  mrpt::io::CFileGZOutputStream gz;
  mrpt::serialization::CArchive::UniquePtr archive;
  std::size_t count = 0;
};

RawlogSink::RawlogSink(const std::string& path) : file_(std::make_unique<File>(path)) {}

RawlogSink::~RawlogSink() {
  file_->gz.close();
  std::error_code ignored;
  std::filesystem::remove(file_->unfinished, ignored);
}

void RawlogSink::write(const mrpt::serialization::CSerializable& entry) {
  *file_->archive << entry;
  ++file_->count;
}

void RawlogSink::finish() {
  file_->gz.close();
  std::error_code error;
  std::filesystem::rename(file_->unfinished, file_->path, error);
  if (error) throw core::InputError(file_->path + ": cannot be written: " + error.message());
}

std::size_t RawlogSink::entries() const { return file_->count; }

}  // namespace helixnav::apps
