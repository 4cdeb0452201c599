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

/// drive.bin of the folder of a run.
std::string drive_file_in(const std::string& folder);

/// The drive.bin of a run that can be driven again: of a navigator without identities and without an earlier map, with a folder; else null.
std::unique_ptr<runs::DriveFile> kept_drive(const Drive& job);

/// Whether a session begins by driving again what the run in that folder drove: it begins where that ended, and the run has kept it.
bool is_driven_again(const std::string& folder, const std::optional<SessionStart>& start);

/// Takes the events up to end_ns off the front of the recording, and returns how many scans they were; labels stay.
std::size_t pass_over(core::Nanoseconds end_ns, core::Recording& recording);

/// Where a session begins at the end of a run that has no drive.bin, and by the log of that run (or a longer one of it): leaves
/// out what that drove, and says so in a remark. InputError where nothing is left. Test: apps/go_on_test.cpp.
void pass_over_driven(const EarlierSession& earlier, core::Recording& recording, std::vector<bool>& withheld);

/// Puts the drive of an earlier run before a recording that goes on where it ended (docs/yesterdays_map.md): its start, its events, no
/// labels for them. What the recording holds of that drive is passed over; a recording whose clock began anew is moved behind
/// it. `withheld` is [scan], empty or as many as there are. Returns how many scans were passed over. Test: apps/go_on_test.cpp, apps/drive_again_test.cpp.
std::size_t put_before(runs::FedDrive before, core::Recording& recording, std::vector<bool>& withheld);

/// Whether a finished run that began a map of its own, and so kept its drive, has it no more.
bool lacks_its_drive(const std::string& folder);

/// What went into the map that a run of the job leaves (core::JointMap::drives): its own drive and, where it went on in an earlier map or
/// was placed on it, what that holds.
std::vector<std::string> drives_in_map(const Drive& job, const runs::Run& run);

}  // namespace helixnav::apps
