// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// A sighting that contradicts its name.
struct ContradictedName {
  core::LandmarkId landmark = core::no_landmark;
  std::optional<core::PointGaussian> seen_at;  ///< in the map; nothing for a range or a bearing alone
  bool is_in_view = true;                      ///< the landmark, where it is mapped
};

/// Decides whether sightings that contradict their names are to be left out, or the motion is wrong and they are right;
/// how much the noise is understated; and which landmarks are not where they are mapped. A value type, small unless
/// there are many contradictions. Source: docs/names.md. Test: supervisor/named/name_integrity_test.cpp.
class NameIntegrity {
 public:
  /// A scan without contradictions.
  void agree(const std::vector<core::LandmarkId>& agreeing);
  /// What a scan with contradictions says about the motion.
  struct AboutMotion {
    double nats_for_slip = 0.0;       ///< for a slip with correct names, over wrong names
    bool agree_about_a_pose = false;  ///< all sightings, on any pose, with more rows than a pose has unknowns
  };
  /// A scan with contradictions. True if names are to blame: its sightings of `contradicting` are to be left out. The
  /// motion is to blame, and all sightings are used, if a slip is likelier and two landmarks contradict at once or some
  /// contradict again; or, however large the motion error, if all agree on a pose and more have contradicted than
  /// agreed since the first contradiction, two of them at once or six in all.
  bool blames_names(const std::vector<ContradictedName>& contradicting, const std::vector<core::LandmarkId>& agreeing,
                    const AboutMotion& about_motion);

  /// νᵀS⁻¹ν of a scan before anything is left out. Its median per degree of freedom, but at least one, is the factor by
  /// which S is too small.
  void note_nis(double nis, int dof);
  void note_unusual();                                 ///< for a scan above anything usual
  double noise_scale() const { return noise_scale_; }  ///< at least 1

  /// Its first sighting bore the wrong name, or it has been moved since: its own sightings contradict it in succession,
  /// and agree where it is instead. False names that are of one landmark and another do not: out of view, a landmark has no
  /// others. Ranges and bearings alone count while it would be in view.
  bool is_misplaced(core::LandmarkId id) const;

  /// `identity` now belongs to another landmark, created anew.
  void begin_anew(std::int64_t identity, core::LandmarkId from);
  bool is_superseded(core::LandmarkId id) const { return superseded_.count(id) > 0; }
  struct BegunAnew {
    std::int64_t identity = 0;
    core::LandmarkId from = core::no_landmark;
  };
  const std::vector<BegunAnew>& begun_anew() const { return begun_anew_; }

 private:
  /// Contradicting sightings since the last one that agreed, less those that disagree with each other.
  struct Elsewhere {
    int sightings = 0;
    std::optional<core::PointGaussian> at;
  };

  void confirm_motion();
  void note_elsewhere(const ContradictedName& name);

  int scans_ = 0;                             ///< that contradicted since the motion was last confirmed, …
  std::set<core::LandmarkId> contradicting_;  ///< … their landmarks, and …
  std::set<core::LandmarkId> agreeing_;       ///< … those that agreed since the first of them
  std::map<core::LandmarkId, Elsewhere> elsewhere_;
  double noise_scale_ = 1.0;
  std::vector<BegunAnew> begun_anew_;
  std::set<core::LandmarkId> superseded_;
};

}  // namespace helixnav::supervisor
