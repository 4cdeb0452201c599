// SPDX-License-Identifier: BSD-3-Clause
// A session that knows where on an earlier map it begins.
#include <memory>

#include "loop/navigation_loop.hpp"
#include "placing/earlier_map.hpp"

namespace helixnav::supervisor {
namespace {

core::PoseGaussian pose_of(const core::JointMap& earlier) {
  check_earlier_map(earlier);
  return {earlier.joint.pose, earlier.joint.covariance.topLeftCorner<3, 3>()};
}

/// As sure as mature or tentative landmarks were when they became so; old is what is far away.
association::LandmarkRecord record_on(const core::JointMap& earlier, std::size_t i, const NavigatorOptions& options) {
  association::LandmarkRecord record;
  record.id = earlier.joint.ids[i];
  record.state = earlier.states[i];
  const bool mature = record.state == core::LandmarkState::mature;
  record.log_odds = mature ? options.life.mature_log_odds : options.life.birth_log_odds;
  record.observations = earlier.observations[i];
  record.hits = mature ? options.life.mature_looks : 1;
  record.last_hit_at_m = record.last_miss_at_m = earlier.joint.pose.position_m();
  const double away_m = (earlier.joint.points_m[i] - earlier.joint.pose.position_m()).norm();
  if (mature && away_m > options.search.old_after_m) record.born_path_m = record.last_seen_path_m = -1e6;
  return record;
}

}  // namespace

NavigationLoop::NavigationLoop(const core::JointMap& earlier, const NavigatorOptions& options)
    : NavigationLoop(pose_of(earlier), options) {
  for (std::size_t i = 0; i < earlier.joint.ids.size(); ++i) {
    const association::LandmarkRecord record = record_on(earlier, i, options);
    belief_.existence.adopt(record);
    if (!earlier.appearances.empty()) belief_.existence.adopt_appearance(record.id, earlier.appearances[i]);
  }
  if (goes_on_behind(earlier, options.search)) {
    go_on_behind(earlier);
  } else {
    belief_.filter = cekf::CompressedEkf(earlier.joint, earlier.next_name, options.filter);
    tape_.drop_drive();
  }
  std::get<Mapping>(mode_).trust(take_checkpoint(belief_, tape_));
}

/// As after a drive that has been taken into the atlas up to now, and of which the tape has nothing.
void NavigationLoop::go_on_behind(const core::JointMap& earlier) {
  tape_ = tape_behind();
  belief_.filter.name_from(earlier.next_name);
  auto drive = std::make_shared<DriveMap>(DriveMap::of_earlier(earlier, phase_length_m(mapped_reach_m(earlier))));
  tape_.append(Tape::Solved{drive->cost()});
  drive->begin_at(tape_.end());
  tape_.hand_on(tape_.end());
  begin_window(std::move(drive), window_to_map());
  undo_ = Undo{};
}

}  // namespace helixnav::supervisor
