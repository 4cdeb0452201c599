// SPDX-License-Identifier: BSD-3-Clause
#include "reading/rawlog_stream.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <mrpt/obs/CAction.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

/// The content size that a gzip file states in its last four bytes (modulo 2³²). zlib reads a truncated file as if it
/// ended there, and MRPT does not check.
bool is_cut_off(const fs::path& path, std::uint64_t content_bytes) {
  std::ifstream file(path, std::ios::binary);
  std::array<unsigned char, 2> magic{};
  file.read(reinterpret_cast<char*>(magic.data()), magic.size());
  if (magic != std::array<unsigned char, 2>{0x1f, 0x8b}) return false;
  std::array<unsigned char, 4> size{};
  file.seekg(-static_cast<std::streamoff>(size.size()), std::ios::end);
  file.read(reinterpret_cast<char*>(size.data()), size.size());
  std::uint32_t stated = 0;
  for (std::size_t i = size.size(); i-- > 0;) stated = stated << 8U | size[i];
  return stated != static_cast<std::uint32_t>(content_bytes);
}

/// The innermost of MRPT's nested messages, without its call stacks.
std::string core_of(const std::exception& error) {
  std::string text = error.what();
  const std::string beginning = "Message:";
  if (const std::size_t last = text.rfind(beginning); last != std::string::npos) {
    text = text.substr(last + beginning.size());
  }
  text = text.substr(0, text.find('\n'));
  return text.substr(std::min(text.size(), text.find_first_not_of(' ')));
}

std::string fault_of(const std::exception& error) {
  const std::string why = core_of(error);
  const bool ended = why.find("EOF") != std::string::npos;
  return ended ? "is cut off" : "cannot be read (of a class unknown here, or no rawlog): " + why;
}

bool is_rawlog_entry(const mrpt::serialization::CSerializable& object) {
  return dynamic_cast<const mrpt::obs::CObservation*>(&object) != nullptr ||
         dynamic_cast<const mrpt::obs::CSensoryFrame*>(&object) != nullptr ||
         dynamic_cast<const mrpt::obs::CActionCollection*>(&object) != nullptr ||
         dynamic_cast<const mrpt::obs::CAction*>(&object) != nullptr;
}

}  // namespace

struct RawlogStream::File {
  struct Handles {
    mrpt::io::CFileGZInputStream gz;
    mrpt::serialization::CArchive::UniquePtr archive;
  };

  explicit File(const std::string& name) : File(name, std::make_unique<Handles>()) {}
  File(const std::string& name, std::unique_ptr<Handles> handles) : File(name, handles->gz, handles->archive) {
    own = std::move(handles);
  }
  File(const std::string& name, mrpt::io::CFileGZInputStream& file, mrpt::serialization::CArchive::UniquePtr& through)
      : path(name), gz(file), archive(through) {
    if (!fs::exists(path)) throw core::InputError(path + ": expected a rawlog, found nothing there");
    if (fs::is_directory(path)) throw core::InputError(path + ": expected a rawlog, found a folder");
    if (!gz.open(path)) throw core::InputError(path + ": cannot be opened for reading");
    archive = mrpt::serialization::archiveUniquePtrFrom<mrpt::io::CStream>(gz);
    read();
    if (!damage.empty()) throw core::InputError(damage);
    if (done) throw core::InputError(path + ": expected a rawlog, found an empty file");
  }

  void read() {
    const std::uint64_t before = gz.getPosition();
    try {
      entry = archive->ReadObject<mrpt::serialization::CSerializable>();
      if (!entry || !is_rawlog_entry(*entry)) {
        damage_at(std::string("holds a ") + (entry ? entry->GetRuntimeClass()->className : "null object") +
                  ", which is no action and no observation");
      }
    } catch (const std::exception& error) {
      entry.reset();
      const bool at_end = gz.getPosition() == before;
      if (at_end && is_cut_off(path, before)) damage_at("is missing: the file was cut off");
      if (!at_end) damage_at(fault_of(error));
    }
    if (!entry) done = true;
  }

  void damage_at(const std::string& what) {
    entry.reset();
    damage = path + ": entry " + std::to_string(count) + " " + what;
  }

  std::string path;
  std::unique_ptr<Handles> own;  ///< null if they are the caller's
  mrpt::io::CFileGZInputStream& gz;
  mrpt::serialization::CArchive::UniquePtr& archive;
  mrpt::serialization::CSerializable::Ptr entry;
  std::size_t count = 0;
  std::string damage;
  bool done = false;
};

RawlogStream::RawlogStream(const std::string& path) : file_(std::make_unique<File>(path)) {}
RawlogStream::RawlogStream(const std::string& path, mrpt::io::CFileGZInputStream& file,
                           mrpt::serialization::CArchive::UniquePtr& archive)
    : file_(std::make_unique<File>(path, file, archive)) {}
RawlogStream::~RawlogStream() = default;
RawlogStream::RawlogStream(RawlogStream&&) noexcept = default;
RawlogStream& RawlogStream::operator=(RawlogStream&&) noexcept = default;

mrpt::serialization::CSerializable::Ptr RawlogStream::next() {
  mrpt::serialization::CSerializable::Ptr entry = std::move(file_->entry);
  file_->entry.reset();
  if (!entry) return entry;
  ++file_->count;
  file_->read();
  return entry;
}

std::size_t RawlogStream::entries() const { return file_->count; }
const std::string& RawlogStream::damage() const { return file_->damage; }

}  // namespace helixnav::apps
