// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include <mrpt/serialization/CSerializable.h>

namespace helixnav::apps {

/// Writes a rawlog, compressed with gzip like MRPT's own. The file appears complete, on `finish`, or not at all.
/// Throws core::InputError on a file system error. Test: mrpt_apps/rawlog_stream_test.cpp.
class RawlogSink {
 public:
  explicit RawlogSink(const std::string& path);
  ~RawlogSink();
  RawlogSink(const RawlogSink&) = delete;
  RawlogSink& operator=(const RawlogSink&) = delete;

  void write(const mrpt::serialization::CSerializable& entry);
  void finish();

  std::size_t entries() const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace helixnav::apps
