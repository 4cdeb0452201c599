// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "helixnav/mrpt_adapter/map_builder.hpp"
#include "slam/rawlog_source.hpp"

namespace helixnav::apps {

/// Feeds a rawlog to a builder, frames and single observations alike; a frame without movement (the first, in kf-slam's own
/// demo) is fed alone. A frame with several observations of landmarks is fed one observation at a time, so that the
/// builder's last data association is that of `seen`.
class SlamFeed {
 public:
  /// Called after each observation that the builder processed, with that observation.
  using Seen = std::function<void(const mrpt::obs::CObservation&)>;

  SlamFeed(mrpt_adapter::MapBuilder& builder, Seen seen);

  /// InputError for anything the builder cannot use and for an observation of landmarks without time; nothing of the
  /// turn is then in the map or, for a frame with several, only what came before.
  void take(const RawlogTurn& turn);

 private:
  void take(const mrpt::obs::CSensoryFrame::Ptr& frame, mrpt::obs::CActionCollection::Ptr movement);
  void observe(const mrpt::obs::CObservation::Ptr& observation, const mrpt::obs::CActionCollection::Ptr& movement);
  void feed(mrpt::obs::CSensoryFrame& frame, const mrpt::obs::CActionCollection::Ptr& movement);

  mrpt_adapter::MapBuilder& builder_;
  Seen seen_;
};

}  // namespace helixnav::apps
