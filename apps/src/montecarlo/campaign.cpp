// SPDX-License-Identifier: BSD-3-Clause
#include "campaign.hpp"

#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "campaign_folder.hpp"
#include "campaign_run.hpp"
#include "campaign_summary.hpp"
#include "common/interrupt.hpp"
#include "common/progress_bar.hpp"

namespace helixnav::apps {
namespace {

std::vector<std::uint64_t> missing_seeds(const Campaign& campaign, const std::set<std::uint64_t>& done) {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t i = 0; i < campaign.runs; ++i) {
    if (done.count(campaign.first_seed + i) == 0) seeds.push_back(campaign.first_seed + i);
  }
  return seeds;
}

/// Workers that take the next seed as they become free. The first exception ends all and is thrown again.
class Workers {
 public:
  Workers(const Campaign& campaign, const std::vector<std::uint64_t>& seeds, CampaignFolder& folder)
      : campaign_(campaign), seeds_(seeds), folder_(folder), progress_("driving", seeds.size(), campaign.quiet) {}

  void run() {
    std::vector<std::thread> threads;
    const std::size_t wanted = std::min<std::size_t>(campaign_.jobs, seeds_.size());
    threads.reserve(wanted);
    try {
      for (std::size_t i = 1; i < wanted; ++i) threads.emplace_back([this] { work(); });
    } catch (const std::exception&) {
      // The system provides no more threads: the existing ones do the work.
    }
    work();
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void work() {
    try {
      for (std::size_t i = next_++; i < seeds_.size() && !interrupt_pending() && !stop_; i = next_++) {
        const std::string row = run_and_judge(campaign_, seeds_[i]);
        if (row.empty()) break;
        const std::lock_guard<std::mutex> lock(mutex_);
        folder_.append(row);
        progress_.advance_to(++done_);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      stop_ = true;
    }
  }

  const Campaign& campaign_;
  const std::vector<std::uint64_t>& seeds_;
  CampaignFolder& folder_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;  // of what follows, and of the folder
  ProgressBar progress_;
  std::size_t done_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

ExitCode run_campaign(const Campaign& campaign) {
  CampaignFolder folder(campaign);
  const std::vector<std::uint64_t> seeds = missing_seeds(campaign, folder.seeds());
  catch_interrupts();
  Workers(campaign, seeds, folder).run();
  const bool stopped = interrupted();
  const Json summary = summary_of(campaign.scenario.name, folder.sort());
  folder.write_summary(summary);
  std::fputs(summary_text(summary).c_str(), stdout);
  std::printf("runs: %s/runs.jsonl   summary: %s/summary.json\n", campaign.out.c_str(), campaign.out.c_str());
  if (!stopped && !interrupted()) return ExitCode::ok;
  std::fprintf(stderr, "helixnav: interrupted; the same command goes on from here\n");
  return ExitCode::interrupted;
}

}  // namespace helixnav::apps
