// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/pf_relocalize/relocalizer.hpp"
#include "helixnav/supervisor/search_options.hpp"
#include "loop/coverage_trace.hpp"

namespace helixnav::supervisor {

/// The input of one step of a search.
struct SearchView {
  const cekf::CompressedEkf& filter;
  const association::LandmarkLife& life;
  const CoverageTrace& coverage;
  const core::Scan& scan;
};

/// The search for where the vehicle is on the old map. Mapping continues meanwhile with the old landmarks excluded (the
/// branch); the particle filter runs beside it, started from the branch's pose and restarted when an attempt fails; the
/// answer is a constellation of branch landmarks that matches old ones better than anywhere else.
/// Nothing here changes filter or map. Source: PROTOTYPE §3, §4. Test: supervisor/closing/closing_test.cpp.
class Search {
 public:
  /// `old` ascending: the landmarks that are not to be associated during the search.
  Search(std::vector<core::LandmarkId> old, double path_m, std::uint64_t seed, const SearchOptions& options);

  bool excludes(core::LandmarkId id) const;
  const std::vector<core::LandmarkId>& old_landmarks() const { return old_; }

  void move(const core::Odometry& odometry);

  /// One scan after the branch has mapped it. Pairs that pass every test, if there are any; what was decided is
  /// appended. The caller closes, or calls refuse().
  std::optional<std::vector<pf_relocalize::ConstellationPair>> look(const SearchView& view,
                                                                    std::vector<core::Decision>& decisions);

  /// Places that explain the constellation about equally well, that of the search first, where the last look found nothing but that to
  /// object to.
  const std::vector<std::vector<pf_relocalize::ConstellationPair>>& contested() const { return contested_; }
  /// Of the looks that were contested, every fifth: comparing the whole branch costs many times a question.
  bool asks_shape() const { return !contested_.empty() && contested_looks_ % 5 == 0; }
  /// One of them was decided for; true if it has been as often as a test is to be passed.
  bool pass(const std::vector<pf_relocalize::ConstellationPair>& pairs);

  /// The closing was refused: this attempt is over.
  void refuse(double path_m);

  /// Nothing of the old map has been in a gate for long, or the search is over. Bare ground tells nothing and counts
  /// for neither.
  bool is_undecided(double path_m) const;
  /// Has gone on for longer than a search that finds its place does.
  bool goes_on(double path_m) const { return seeing_m(path_m) > options_.idle_m; }
  /// Has gone on for as long as any search may.
  bool is_over(double path_m) const;
  /// There was too little about the vehicle to decide that the ground is new: is_undecided() is asked again a little later.
  void wait(double path_m);
  double begun_path_m() const { return begun_path_m_; }

  /// T_world_robot of the heaviest mode at the last look; nothing while no attempt runs.
  std::optional<core::PoseGaussian> heaviest_mode(const cekf::CompressedEkf& filter) const;

  /// T_world_robot of the particles, every n-th; empty while no attempt runs.
  std::vector<core::Pose2> cloud(const cekf::CompressedEkf& filter) const;

  /// Same, as they were drawn on helices, if the last look began an attempt; else empty.
  std::vector<core::Pose2> drawn(const cekf::CompressedEkf& filter) const;

 private:
  struct Attempt {
    pf_relocalize::Relocalizer relocalizer;
    core::LandmarkId base_a, base_b;
    double begun_path_m;
    double next_question_path_m = 0.0;
    std::vector<pf_relocalize::ConstellationPair> passed;  ///< pairs of the last test if it was passed
    int passes = 0;
  };

  bool sees_enough(const core::Scan& scan) const;
  /// Distance driven since the search began where there was something to see.
  double seeing_m(double path_m) const;
  bool is_promising(const SearchView& view);
  void start(const SearchView& view, std::vector<core::Decision>& decisions);
  std::optional<std::vector<pf_relocalize::ConstellationPair>> question(const SearchView& view,
                                                                        std::vector<core::Decision>& decisions);
  using Reason = core::AttemptEnded::Reason;
  void end_attempt(Reason reason, double path_m, std::vector<core::Decision>& decisions);

  SearchOptions options_;
  std::vector<core::LandmarkId> old_;
  double begun_path_m_;
  std::uint64_t seed_;
  core::Odometry motion_;  ///< since the last look
  double last_look_path_m_;
  double blind_m_ = 0.0;         ///< driven with too few observations in view to say anything about the place
  double last_in_gate_m_ = 0.0;  ///< of seeing_m(), when an observation was last in an old landmark's gate
  double next_start_path_m_ = 0.0;
  int starts_ = 0;
  int questions_ = 0;
  std::optional<Attempt> attempt_;
  std::vector<std::vector<pf_relocalize::ConstellationPair>> contested_;
  std::vector<pf_relocalize::ConstellationPair> decided_;  ///< of them last
  int decided_passes_ = 0;
  int contested_looks_ = 0;
  bool has_just_started_ = false;  ///< the attempt, in the last look
};

}  // namespace helixnav::supervisor
