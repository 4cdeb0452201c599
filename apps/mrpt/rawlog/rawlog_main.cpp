// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "convert/convert_log.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "program.hpp"
#include "rawlog/observations_only.hpp"
#include "rawlog/write_acfr.hpp"
#include "rawlog/write_recording.hpp"
#include "reading/read_rawlog.hpp"
#include "settings/validators.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

struct RawlogJob {
  std::string in;
  std::string out;
  std::string to;
  mrpt_adapter::MapBuilderOptions sensors;
  bool no_ids = false;
  bool observations_only = false;
  bool overwrite = false;
};

bool is_rawlog(const std::string& path) { return fs::path(path).extension() == ".rawlog"; }

void print(const RawlogCounts& counts, const std::string& out) {
  std::printf("scans %zu, movements %zu, observations %zu\n", counts.scans, counts.movements, counts.observations);
  if (counts.repeated_labels > 0) {
    std::printf("without their label: %zu observations of an object that the same scan shows twice\n",
                counts.repeated_labels);
  }
  std::printf("written: %s (rawlog)\n", out.c_str());
}

RawlogCounts write_rawlog(const RawlogJob& job) {
  using logs::LogFormat;
  const LandmarkIds ids = job.no_ids ? LandmarkIds::none : LandmarkIds::labels;
  switch (logs::recognise(job.in)) {
    case LogFormat::acfr_ascii:
      return write_acfr(logs::read_acfr_ascii(job.in), {}, job.out);
    case LogFormat::victoria_park_mat:
      return write_acfr(logs::read_victoria_park_mat(job.in), {}, job.out);
    case LogFormat::car_park_mat: {
      const fs::path file = fs::is_directory(job.in) ? fs::path(job.in) / "data_set.mat" : fs::path(job.in);
      return write_acfr(logs::read_car_park_mat(file), logs::car_park_settings(), job.out);
    }
    default:
      return write_recording(logs::read_recording(job.in), job.out, ids);
  }
}

GraphFormat text_format(const RawlogJob& job) {
  const std::string extension = fs::path(job.out).extension().string();
  if (const auto format = format_by_name(job.to)) return *format;
  if (const auto format = format_by_extension(extension)) return *format;
  throw CLI::ValidationError(
      "OUT", "'" + extension + "' says no format; give --to " + CLI::detail::join(format_names(), ", --to ") +
                 ", or an extension of .rawlog, .circles, .lines, .dlr, .g2o, .isam, .gtsam, .jsonl");
}

ExitCode convert(const RawlogJob& job) {
  const bool from_rawlog = is_rawlog(job.in);
  const bool to_rawlog = is_rawlog(job.out) && job.to.empty();
  if (!from_rawlog && !to_rawlog)
    throw CLI::ValidationError("IN, OUT", "neither of the two is a .rawlog; helixnav convert does the rest");
  if (from_rawlog && to_rawlog && !job.observations_only) {
    throw CLI::ValidationError("OUT", "from rawlog to rawlog there is --observations-only");
  }
  if (job.observations_only && !(from_rawlog && to_rawlog))
    throw CLI::ValidationError("--observations-only", "goes from rawlog to rawlog");
  if (fs::is_directory(job.out)) throw core::InputError(job.out + ": expected a file to write, found a folder");
  if (fs::exists(job.out) && !job.overwrite) {
    throw core::InputError(job.out + ": the file is there already; choose another name, or --overwrite to replace it");
  }
  if (job.observations_only) {
    std::printf("observations %zu\nwritten: %s (rawlog)\n", write_observations_only(job.in, job.out), job.out.c_str());
  } else if (to_rawlog) {
    print(write_rawlog(job), job.out);
  } else {
    const GraphFormat format = text_format(job);
    const Converted converted =
        convert_recording(read_rawlog(job.in, job.sensors), job.in, job.out, format, {}, 0, job.overwrite);
    std::fputs(text_of(converted).c_str(), stdout);
    std::printf("written: %s (%s)\n", job.out.c_str(), name_of(format).c_str());
  }
  return ExitCode::ok;
}

}  // namespace
}  // namespace helixnav::apps

int main(int argc, char** argv) {
  using namespace helixnav::apps;
  CLI::App app{"Write a log as an MRPT rawlog, or a rawlog as something else.", "helixnav-rawlog"};
  RawlogJob job;
  app.add_option("IN", job.in, "Rawlog, or any log that helixnav replay knows")->required();
  app.add_option("OUT", job.out, "File to write; its extension is the format")->required();
  app.add_option("--to", job.to, "Format of OUT, whatever its name")->check(one_of(format_names()));
  app.add_flag("--no-ids", job.no_ids, "Leave the labels of IN out: no landmarkID in the rawlog");
  app.add_flag("--observations-only", job.observations_only,
               "From rawlog to rawlog: take frames apart, movements become odometer readings (without covariance)");
  app.add_option("--detector", job.sensors.detector, "What finds landmarks in the range scans of a rawlog")
      ->capture_default_str()
      ->check(one_of({"trees", "reflectors", "none"}));
  app.add_flag("--overwrite", job.overwrite,
               "Replace OUT, and the vehicle.toml beside JSON Lines, when they are there");
  app.footer(
      "To a rawlog: ACFR logs raw, as single observations (range scans, GPS, wheel and steering, odometry); all "
      "others\n"
      "as pairs of action and sensory frame, landmarks as CObservationBearingRange.\n"
      "From a rawlog: .circles .lines .dlr (DLR text), .g2o .isam .gtsam (need landmarkIDs), .jsonl (what helixnav\n"
      "replay and stream read, with a vehicle.toml beside it).\n\n"
      "Examples:\n"
      "  helixnav-rawlog victoria_park_ascii.zip park.rawlog\n"
      "  helixnav-rawlog map.circles run_e.rawlog\n"
      "  helixnav-rawlog kf-slam_demo.rawlog demo.g2o\n"
      "  helixnav-rawlog kf-slam_demo.rawlog demo.jsonl && helixnav stream --vehicle vehicle.toml < demo.jsonl\n"
      "  helixnav-rawlog kf-slam_demo.rawlog observations.rawlog --observations-only\n");
  return run_program(app, [&] {
    app.parse(argc, argv);
    return convert(job);
  });
}
