// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

namespace helixnav::apps {

/// Reads a rawlog entry by entry, compressed with gzip or not. Everything before a damaged place is returned first.
/// Throws core::InputError if the file does not exist or does not begin as a rawlog.
/// Test: mrpt_apps/rawlog_stream_test.cpp.
class RawlogStream {
 public:
  explicit RawlogStream(const std::string& path);

  /// The same with a file and an archive owned by the caller, which it opens and which outlive it.
  RawlogStream(const std::string& path, mrpt::io::CFileGZInputStream& file,
               mrpt::serialization::CArchive::UniquePtr& archive);

  ~RawlogStream();
  RawlogStream(RawlogStream&&) noexcept;
  RawlogStream& operator=(RawlogStream&&) noexcept;

  /// The next entry: CActionCollection, CSensoryFrame or an observation; empty at the end and where the file is damaged.
  mrpt::serialization::CSerializable::Ptr next();

  std::size_t entries() const;  ///< handed out so far

  /// Empty if the file ended cleanly; else the entry and its fault: truncated, of an unknown class, not a rawlog.
  const std::string& damage() const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace helixnav::apps
