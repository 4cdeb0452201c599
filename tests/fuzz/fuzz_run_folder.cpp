// SPDX-License-Identifier: BSD-3-Clause
// A good run folder with some files replaced by the input: read, judged, explained and rendered.
#include "fuzz_input.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/reports/explanation.hpp"
#include "helixnav/reports/report.hpp"
#include "helixnav/reports/summary.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "run_example.hpp"

namespace {

using namespace helixnav;

const std::map<std::string, std::string>& good_files() {
  static const std::map<std::string, std::string> files = [] {
    const std::string run = (fuzz::folder() / "good").string();
    runs::write_example(run, 60);
    std::map<std::string, std::string> read;
    for (const auto& entry : std::filesystem::directory_iterator(run)) {
      read[entry.path().filename().string()] = files::read_whole_file(entry.path().string());
    }
    return read;
  }();
  return files;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const helixnav::testing::TemporaryFolder folder;
  const std::map<std::string, std::string> changed = fuzz::files_of(data, size);
  for (const auto& [name, text] : good_files()) {
    if (name == "report.html" || name == "summary.json") continue;
    const auto other = changed.find(name);
    folder.write(name, other == changed.end() ? text : other->second);
  }
  fuzz::read_or_refuse([&] {
    const runs::Run run = runs::read_run(folder.path().string());
    const evaluation::Evaluation evaluation = evaluation::evaluate(run);
    reports::evaluation_text(evaluation);
    reports::summary_json(run, evaluation);
    reports::render_report(run, evaluation);
    reports::explain_run(run);
    if (!run.steps.empty()) reports::explain_step(run, run.steps.back().step);
    reports::explain_closure(run, 1);
  });
  return 0;
}
