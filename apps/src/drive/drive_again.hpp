// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drive.hpp"
#include "earlier_session.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/runs/drive_file.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// drive.bin in the folder of a run.
std::string drive_file_in(const std::string& folder);

/// The drive.bin of a run that can be driven again: a navigator without identities and without an earlier map, with a folder; else null.
std::unique_ptr<runs::DriveFile> kept_drive(const Drive& job);

/// Whether a session begins by driving again what the run in that folder drove: it starts at that run's end, and the run has kept
/// its drive.
bool is_driven_again(const std::string& folder, const std::optional<SessionStart>& start);

/// Takes the events up to end_ns off the front of the recording and returns their number of scans; labels stay.
std::size_t pass_over(core::Nanoseconds end_ns, core::Recording& recording);

/// For a session that begins at the end of a run that has no drive.bin, with the log of that run (or a longer one of it):
/// leaves out what that run drove, and reports this in a remark. InputError if nothing is left. Test: apps/go_on_test.cpp.
void pass_over_driven(const EarlierSession& earlier, core::Recording& recording, std::vector<bool>& withheld);

/// Puts the drive of an earlier run before a recording that continues from its end (docs/yesterdays_map.md): its start,
/// its events, no labels for them. The part of the recording that belongs to that drive is skipped; a recording whose
/// clock was reset is moved behind it. `withheld` is [scan], empty or as many as there are. Returns how many scans were
/// skipped. Test: apps/go_on_test.cpp, apps/drive_again_test.cpp.
std::size_t put_before(runs::FedDrive before, core::Recording& recording, std::vector<bool>& withheld);

/// Whether a finished run that began its own map, and so kept its drive, no longer has it.
bool lacks_its_drive(const std::string& folder);

/// What went into the map that a run of the job leaves (core::JointMap::drives): its own drive and, if it continued in an earlier map or
/// was placed on it, the drives in that.
std::vector<std::string> drives_in_map(const Drive& job, const runs::Run& run);

}  // namespace helixnav::apps
