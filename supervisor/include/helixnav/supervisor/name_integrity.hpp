// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// Whether sightings that contradict their names are to be left out, or the motion is wrong and they right; how much noise is
/// understated; and which landmarks do not stand where they are mapped. A value, small unless much contradicts.
/// Source: docs/names.md. Test: supervisor/named/name_integrity_test.cpp.
class NameIntegrity {
 public:
  /// A scan that contradicts nothing.
  void agree(const std::vector<core::LandmarkId>& agreeing);
  /// What a scan that contradicts says of the motion.
  struct AboutMotion {
    double nats_for_slip = 0.0;       ///< of a slip with right names, over wrong names
    bool agree_about_a_pose = false;  ///< all sightings, anywhere, and in more rows than a pose has unknowns
  };
  /// A scan that does. True where names are to blame: its sightings of `contradicting` are to be left out. The motion is, and all
  /// are used, where a slip is likelier and two landmarks contradict at once, or some do again; or, however far it went,
  /// where all agree about a pose and more have contradicted than agreed since the first, two of them at once or six in all.
  bool blames_names(const std::vector<core::LandmarkId>& contradicting, const std::vector<core::LandmarkId>& agreeing,
                    const AboutMotion& about_motion);

  /// νᵀS⁻¹ν of a scan before anything is left out. Its median, for a degree of freedom and not below one, is the scale by
  /// which S is smaller than it should be.
  void note_nis(double nis, int dof);
  void note_unusual();                                 ///< of a scan that is above all that is usual
  double noise_scale() const { return noise_scale_; }  ///< at least 1

  /// The first sighting had another's name, or it was moved since: its own say so one after another.
  bool is_misplaced(core::LandmarkId id) const;

  /// `identity` is that of another landmark now, begun anew.
  void begin_anew(std::int64_t identity, core::LandmarkId from);
  bool is_superseded(core::LandmarkId id) const { return superseded_.count(id) > 0; }
  struct BegunAnew {
    std::int64_t identity = 0;
    core::LandmarkId from = core::no_landmark;
  };
  const std::vector<BegunAnew>& begun_anew() const { return begun_anew_; }

 private:
  void confirm_motion();

  int scans_ = 0;                             ///< that contradicted since the motion was last confirmed, …
  std::set<core::LandmarkId> contradicting_;  ///< … their landmarks, and …
  std::set<core::LandmarkId> agreeing_;       ///< … those that agreed since the first of them
  std::map<core::LandmarkId, int> in_a_row_;  ///< sightings that contradicted, since the last that agreed
  double noise_scale_ = 1.0;
  std::vector<BegunAnew> begun_anew_;
  std::set<core::LandmarkId> superseded_;
};

}  // namespace helixnav::supervisor
