// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "helixnav/files/folder_lock.hpp"

namespace helixnav::apps {

struct Campaign;

using Json = nlohmann::ordered_json;

/// The folder of a campaign: manifest.json (what defines the runs), runs.jsonl (one line per run), summary.json.
class CampaignFolder {
 public:
  /// Begins the folder, or continues from its contents: an incomplete last line is dropped. InputError if it holds
  /// other things, another process drives it, or it holds a campaign of another scenario, configuration or build; the
  /// message names the first difference.
  explicit CampaignFolder(const Campaign& campaign);

  /// Of the runs in the folder.
  std::set<std::uint64_t> seeds() const;

  /// One run, handed to the operating system when this returns.
  void append(const std::string& row);

  /// Rewrites the lines in order of seed, so that they do not show who finished first, and returns them.
  std::vector<Json> sort();

  void write_summary(const Json& summary) const;

 private:
  void write_rows(const std::vector<Json>& rows);
  void take_up(Json manifest) const;

  std::string path_;
  std::optional<files::FolderLock> lock_;
  std::ofstream rows_;
};

}  // namespace helixnav::apps
