// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CSerializable.h>

#include "helixnav/mrpt_adapter/map_builder.hpp"

namespace helixnav::apps {

/// Feeds the entries of a rawlog to a builder, frames and single observations alike: a movement with the frame or the
/// observation that follows, a frame without one (the first, in kf-slam's own demo) alone. A frame with several
/// observations of landmarks goes in one by one, so that the builder's last data association is that of `seen`.
class SlamFeed {
 public:
  /// Called after each observation that the builder looked at, with that observation.
  using Seen = std::function<void(const mrpt::obs::CObservation&)>;

  SlamFeed(mrpt_adapter::MapBuilder& builder, Seen seen);

  /// InputError for what the builder cannot use and for an observation of landmarks without time; nothing of the entry
  /// is then in the map, or of a frame with several, what came before.
  void take(const mrpt::serialization::CSerializable::Ptr& entry);

 private:
  void take(const mrpt::obs::CSensoryFrame::Ptr& frame);
  void observe(const mrpt::obs::CObservation::Ptr& observation);
  void feed(mrpt::obs::CSensoryFrame& frame);

  mrpt_adapter::MapBuilder& builder_;
  Seen seen_;
  mrpt::obs::CActionCollection::Ptr movement_;  ///< whose frame is still to come
};

}  // namespace helixnav::apps
