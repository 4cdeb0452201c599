// SPDX-License-Identifier: BSD-3-Clause
#include "small_logs.hpp"

#include <archive.h>
#include <archive_entry.h>

#include "helixnav/logs/sick_scan.hpp"

namespace helixnav::apps {
namespace {

std::string scan_text(const std::string& time) {
  std::string text = time;
  for (int beam = 0; beam < logs::SickScan::beams; ++beam) text += "\t2.50";
  return text;
}

}  // namespace

NamedTexts small_release() {
  return {{"DRS.txt", "0.1\t 1.0\t0.05\r\n0.2\t 1.5\t0.06\r\n"},
          {"LASER.txt", scan_text("0.15") + "\t" + scan_text("0.2")},
          {"GPS.txt", "0.0\t 3.0\t 4.0\r\n"},
          {"Sensors_manager.txt", "0.0\t1\t1\r\n0.1\t2\t1\r\n0.15\t3\t1\r\n0.2\t3\t2\r\n0.2\t2\t2\r\n"}};
}

std::filesystem::path write_zip(const std::filesystem::path& path, const NamedTexts& files) {
  archive* zip = archive_write_new();
  archive_write_set_format_zip(zip);
  archive_write_zip_set_compression_store(zip);
  archive_write_open_filename(zip, path.c_str());
  for (const auto& [name, text] : files) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(text.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    archive_write_header(zip, entry);
    archive_write_data(zip, text.data(), text.size());
    archive_entry_free(entry);
  }
  archive_write_free(zip);
  return path;
}

std::string circle_graph(int steps) {
  // Poses and landmarks share their numbers: pose i is 0 or i + 1, the landmark is 1.
  std::string text = "LANDMARK 0 1 0 20 5 0 5\n";
  int pose = 0;
  for (int step = 0; step < steps; ++step) {
    const int next = pose == 0 ? 2 : pose + 1;
    text += "ODOMETRY " + std::to_string(pose) + ' ' + std::to_string(next) + " 0.19999 0.001 0.01 100 0 0 500 0 500\n";
    text += "LANDMARK " + std::to_string(next) + " 1 0 20 5 0 5\n";
    pose = next;
  }
  return text;
}

}  // namespace helixnav::apps
