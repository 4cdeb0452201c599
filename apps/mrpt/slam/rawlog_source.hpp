// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <mrpt/apps/DataSourceRawlog.h>

#include "helixnav/logs/acfr_recording.hpp"
#include "reading/wheel_steering.hpp"

namespace helixnav::apps {

/// What a builder takes at a time: a frame or a single observation, with the movement before it if there is one; or a
/// movement that is followed by another movement.
struct RawlogTurn {
  mrpt::obs::CActionCollection::Ptr movement;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr observation;
};

/// MRPT's data source for rawlogs, of frames and of single observations, with its file, offset and entry counter. The search
/// for the next turn is our own: MRPT 2.5.8 ends at a truncated file as if it were complete, drops a frame that no action
/// precedes (the first one in kf-slam's own demo) and one of two consecutive actions.
/// Test: mrpt_apps/rawlog_source_test.cpp.
class RawlogSource : public mrpt::apps::DataSourceRawlog {
 public:
  /// Reads the file, up to its end or a damaged place, and leaves out the first `offset` entries. InputError as for
  /// RawlogStream; `vehicle` as in with_movements.
  RawlogSource(const std::string& path, std::size_t offset, const logs::AcfrSettings& vehicle);

  /// Empty at the end. A movement that nothing follows is not returned.
  std::optional<RawlogTurn> next();

  const RawlogEntries& entries() const { return entries_; }  ///< behind the offset
  std::size_t offset() const { return m_rawlog_offset; }
  std::size_t size() const { return skipped_ + entries_.size(); }
  std::size_t last_entry() const { return m_rawlogEntry - 1; }  ///< counted from 0, the one that next() returned

  /// What is wrong with the file after the last entry; empty if nothing is.
  const std::string& damage() const { return damage_; }

 protected:
  bool impl_get_next_observations(mrpt::obs::CActionCollection::Ptr& movement, mrpt::obs::CSensoryFrame::Ptr& frame,
                                  mrpt::obs::CObservation::Ptr& observation) override;

 private:
  RawlogEntries entries_;
  std::size_t skipped_ = 0;
  std::string damage_;
};

}  // namespace helixnav::apps
