// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

namespace helixnav::apps {

/// Reads a rawlog entry by entry, compressed with gzip or not. What stands before a damaged place is handed out first.
/// Throws core::InputError when the file is not there or does not begin as a rawlog.
/// Test: mrpt_apps/rawlog_stream_test.cpp.
class RawlogStream {
 public:
  explicit RawlogStream(const std::string& path);

  /// The same through a file and an archive of the caller's, which it opens and which outlive it.
  RawlogStream(const std::string& path, mrpt::io::CFileGZInputStream& file,
               mrpt::serialization::CArchive::UniquePtr& archive);

  ~RawlogStream();
  RawlogStream(RawlogStream&&) noexcept;
  RawlogStream& operator=(RawlogStream&&) noexcept;

  /// The next entry: CActionCollection, CSensoryFrame or an observation; empty at the end and where the file is damaged.
  mrpt::serialization::CSerializable::Ptr next();

  std::size_t entries() const;  ///< handed out so far

  /// Empty when the file ended well; else the entry, and what is wrong with it: truncated, of an unknown class, no rawlog.
  const std::string& damage() const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace helixnav::apps
