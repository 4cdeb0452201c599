// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "configuration.hpp"
#include "gil.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/own_stream.hpp"
#include "map.hpp"
#include "stream/live_navigator.hpp"

namespace helixnav::python {
namespace {

using Refused = std::tuple<std::size_t, std::string, std::string>;

/// What `helixnav stream` makes of its lines, for a program that has them itself. Calls take turns.
class Stream {
 public:
  explicit Stream(Configuration configuration)
      : configuration_(std::move(configuration)),
        input_(*configuration_.settings.logs.vehicle, configuration_.settings.known_association),
        navigator_(configuration_.settings) {}

  std::vector<core::StepReport> take(const std::string& line) {
    const std::lock_guard hold(mutex_);
    return navigate(input_.take(line, ++lines_));
  }

  std::vector<core::StepReport> finish() {
    const std::lock_guard hold(mutex_);
    return navigate(input_.finish());
  }

  std::vector<Refused> take_refused() {
    const std::lock_guard hold(mutex_);
    return std::exchange(refused_, {});
  }

  std::vector<std::string> take_remarks() {
    const std::lock_guard hold(mutex_);
    return std::exchange(remarks_, {});
  }

  Map map() {
    const std::lock_guard hold(mutex_);
    return Map{navigator_.map()};
  }

  std::optional<core::JointMap> joint_map() {
    const std::lock_guard hold(mutex_);
    return navigator_.joint_map();
  }

 private:
  /// A scan on which the mathematics breaks is left out, as the program leaves it out.
  std::vector<core::StepReport> navigate(logs::StreamedEvents next) {
    for (const logs::RefusedLine& one : next.refused) refused_.emplace_back(one.line, one.key, one.why);
    remarks_.insert(remarks_.end(), next.remarks.begin(), next.remarks.end());
    navigator_.prepare(next.recording);
    std::vector<core::StepReport> reports;
    apps::feed_live(
        next, navigator_, steps_, [&](core::StepReport report, std::size_t) { reports.push_back(std::move(report)); },
        [&](std::size_t line, const std::exception& error, bool) { refused_.emplace_back(line, "", error.what()); });
    return reports;
  }

  const Configuration configuration_;
  logs::OwnStream input_;
  apps::LiveNavigator navigator_;
  std::vector<Refused> refused_;
  std::vector<std::string> remarks_;
  std::size_t lines_ = 0;
  std::int64_t steps_ = 0;
  std::mutex mutex_;
};

std::unique_ptr<Stream> stream_of(const std::filesystem::path& vehicle, const py::dict& options) {
  Configuration configuration = configuration_of(options, vehicle.string(), {}, Filter::compressed_ekf);
  if (configuration.settings.gps.fuse)
    throw core::InputError("gps.use: fuse needs a whole log: a stream uses no fixes");
  if (!configuration.settings.logs.vehicle) throw core::InputError("Stream: expected a vehicle.toml");
  return std::make_unique<Stream>(std::move(configuration));
}

/// NumPy's scalars are no numbers to the json of Python.
py::object plain_number(const py::object& value) {
  if (py::isinstance(value, py::module_::import("numpy").attr("generic"))) return value.attr("item")();
  throw py::type_error("line: expected numbers, texts, lists and dictionaries, found " +
                       std::string(py::str(py::type::handle_of(value).attr("__name__"))));
}

/// A line as it is, or the JSON of a dictionary.
std::string line_of(const py::object& line) {
  if (py::isinstance<py::str>(line)) return utf8_from(line, "line");
  if (py::isinstance<py::dict>(line)) {
    const py::cpp_function plain(&plain_number);
    return utf8_from(py::module_::import("json").attr("dumps")(line, py::arg("default") = plain), "line");
  }
  throw py::type_error("line: expected a text or a dictionary");
}

}  // namespace

void bind_stream(py::module_& module) {
  py::class_<Stream>(
      module, "Stream",
      "helixnav stream for your own program: takes rows of odometry and detections with their times, as they arrive. A "
      "scan is processed where it was taken: the motion is split there, and a scan up to a second late is waited for.")
      .def(py::init(&stream_of), py::arg("vehicle"), py::arg("options") = py::dict(),
           "`vehicle`: a vehicle.toml, which gives each sensor's reach and view. Options as in a configuration file.")
      .def(
          "take",
          [](Stream& self, const py::object& line) {
            const std::string text = line_of(line);
            const WithoutGil released;
            return self.take(text);
          },
          py::arg("line"),
          "Takes a line of JSON Lines, or the equivalent dictionary, e.g. {'odometry': {'t': 0.1, 'v': 1.2, "
          "'omega_degps': 3}}. Returns the StepReports of the scans that it made due: a scan is due once the odometry "
          "has reached its time.")
      .def("finish", &Stream::finish, py::call_guard<WithoutGil>(),
           "Ends the input; returns the StepReports of scans still waiting.")
      .def("take_refused", &Stream::take_refused, py::call_guard<WithoutGil>(),
           "(line, key, why) for input that was not used since the last call.")
      .def("take_remarks", &Stream::take_remarks, py::call_guard<WithoutGil>(),
           "Sentences on what is doubtful since the last call.")
      .def_property_readonly(
          "map",
          [](Stream& self) {
            const WithoutGil released;
            return self.map();
          },
          "The current Map.")
      .def("joint_map", &Stream::joint_map, py::call_guard<WithoutGil>(),
           "The JointMap for another session; None before the first scan, or if the map is too large.");
}

}  // namespace helixnav::python
