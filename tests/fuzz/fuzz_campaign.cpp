// SPDX-License-Identifier: BSD-3-Clause
// The folder of a resumed campaign: runs.jsonl, or what follows "=== name" for the other files.
#include "fuzz_input.hpp"
#include "montecarlo/campaign.hpp"
#include "montecarlo/campaign_folder.hpp"
#include "montecarlo/campaign_summary.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helixnav;
  const helixnav::testing::TemporaryFolder folder;
  apps::Campaign campaign;
  campaign.scenario.name = "input";
  campaign.out = folder.path().string();
  apps::CampaignFolder{campaign};  // its manifest
  const std::map<std::string, std::string> files = fuzz::files_of(data, size);
  if (files.empty()) folder.write("runs.jsonl", std::string_view(reinterpret_cast<const char*>(data), size));
  for (const char* name : {"runs.jsonl", "manifest.json"}) {
    const auto changed = files.find(name);
    if (changed != files.end()) folder.write(name, changed->second);
  }
  fuzz::read_or_refuse([&] {
    apps::CampaignFolder again(campaign);
    again.seeds();
    const apps::Json summary = apps::summary_of("input", again.sort());
    apps::summary_text(summary);
    again.write_summary(summary);
  });
  return 0;
}
