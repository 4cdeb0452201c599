// SPDX-License-Identifier: BSD-3-Clause
#include "slam/rawlog_source.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <mrpt/obs/CAction.h>

#include "reading/rawlog_stream.hpp"

namespace helixnav::apps {
namespace {

using mrpt::obs::CActionCollection;

/// Null if it is not a movement; a single action becomes a collection of one.
CActionCollection::Ptr movement_in(const mrpt::serialization::CSerializable::Ptr& entry) {
  const auto action = std::dynamic_pointer_cast<mrpt::obs::CAction>(entry);
  if (!action) return std::dynamic_pointer_cast<CActionCollection>(entry);
  auto alone = std::make_shared<CActionCollection>();
  alone->insertPtr(action);
  return alone;
}

}  // namespace

RawlogSource::RawlogSource(const std::string& path, std::size_t offset, const logs::AcfrSettings& vehicle) {
  m_rawlogFileName = path;
  m_rawlog_offset = offset;
  RawlogStream stream(m_rawlogFileName, m_rawlog_io, m_rawlog_arch);
  while (auto entry = stream.next()) entries_.push_back(std::move(entry));
  damage_ = stream.damage();
  skipped_ = std::min(m_rawlog_offset, entries_.size());
  entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(skipped_));
  entries_ = with_movements(std::move(entries_), vehicle);
  m_rawlogEntry = skipped_;
}

std::optional<RawlogTurn> RawlogSource::next() {
  RawlogTurn turn;
  if (!impl_get_next_observations(turn.movement, turn.frame, turn.observation)) return std::nullopt;
  return turn;
}

bool RawlogSource::impl_get_next_observations(CActionCollection::Ptr& movement, mrpt::obs::CSensoryFrame::Ptr& frame,
                                              mrpt::obs::CObservation::Ptr& observation) {
  movement.reset();
  frame.reset();
  observation.reset();
  while (m_rawlogEntry < size()) {
    const auto& entry = entries_[m_rawlogEntry - skipped_];
    auto moved = movement_in(entry);
    if (moved && movement) return true;
    ++m_rawlogEntry;
    if (moved) {
      movement = std::move(moved);
      continue;
    }
    frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(entry);
    observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(entry);
    return true;
  }
  movement.reset();
  return false;
}

}  // namespace helixnav::apps
