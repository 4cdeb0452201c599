// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <variant>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// What was done to the filter since a search began, so that it can be done again when it is known which landmark of the
/// branch is which old one. Begins with a snapshot, whose phase and all later ones the filter keeps meanwhile.
/// Memory: snapshot and CompressedEkf::kept_bytes, and about 200 bytes an observation.
/// Test: supervisor/replay_test.cpp.
class BranchJournal {
 public:
  explicit BranchJournal(cekf::CompressedEkf& filter);

  void predict(const core::Odometry& odometry) { entries_.emplace_back(odometry); }
  void fix(const core::AbsoluteFix& fix) { entries_.emplace_back(fix); }
  /// One scan after the filter was updated and augmented by it.
  void observe(const core::Scan& scan, const core::StepReport& report);
  /// A landmark that the filter lost after the last scan.
  void remove(core::LandmarkId id) { entries_.emplace_back(Removal{id}); }

  /// νᵀS⁻¹ν of all scans.
  const cekf::UpdateResult& cost() const { return cost_; }
  /// Born since the journal was begun.
  bool has_birth_of(core::LandmarkId id) const { return born_.count(id) > 0; }

  /// Restores the filter and does everything again, with each branch landmark in `old_of` being the old one from its birth
  /// on; scans that see such a one are iterated. Every other landmark keeps its id. Returns the cost, as cost().
  /// Throws what the filter throws, which is then in between. Cost: that of the scans themselves, some times over.
  cekf::UpdateResult replay(cekf::CompressedEkf& filter,
                            const std::map<core::LandmarkId, core::LandmarkId>& old_of) const;

  std::size_t bytes() const;

 private:
  struct Birth {
    core::LandmarkId id;
    cekf::Match sighting;
  };
  struct ScanEntry {
    std::vector<cekf::Match> matches;
    std::vector<Birth> births;
  };
  struct Removal {
    core::LandmarkId id;
  };
  using Entry = std::variant<core::Odometry, core::AbsoluteFix, ScanEntry, Removal>;

  static cekf::UpdateResult repeat(cekf::CompressedEkf& filter, const ScanEntry& entry,
                                   const std::map<core::LandmarkId, core::LandmarkId>& old_of);

  cekf::Snapshot snapshot_;
  std::vector<Entry> entries_;
  std::set<core::LandmarkId> born_;
  cekf::UpdateResult cost_;
};

}  // namespace helixnav::supervisor
