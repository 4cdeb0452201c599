// SPDX-License-Identifier: BSD-3-Clause
#include "bind.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"

namespace helixnav::python {
namespace {

/// The three kinds of error (docs/adr/0005-error-kinds.md) by what Python calls their kind.
void bind_errors(py::module_& module) {
  py::register_exception<core::InputError>(module, "InputError", PyExc_ValueError).doc() =
      "A file, an option or a value that cannot be used; says where and what was expected.";
  py::register_exception<core::PreconditionError>(module, "PreconditionError", PyExc_ValueError).doc() =
      "A call whose arguments break what its documentation asks for; the object is as it was.";
  py::register_exception<core::NumericalError>(module, "NumericalError", PyExc_ArithmeticError).doc() =
      "The mathematics broke down; the object is as it was before the call.";
}

}  // namespace

PYBIND11_MODULE(_helixnav, module) {
  module.attr("__version__") = std::string(core::version());
  module.attr("__commit__") = std::string(core::commit());
  bind_errors(module);
  bind_events(module);
  bind_log(module);
  bind_map(module);
  bind_navigator(module);
  bind_fastslam(module);
  bind_run(module);
  bind_join(module);
  bind_team(module);
  bind_team_log(module);
}

}  // namespace helixnav::python
