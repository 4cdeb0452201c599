// SPDX-License-Identifier: BSD-3-Clause
#include <exception>

#include "arrays.hpp"
#include "bind.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"

namespace helixnav::python {
namespace {

/// What an error says has paths in it, which need not be UTF-8.
template <class Error>
py::exception<Error>& bind_error(py::module_& module, const char* name, PyObject* kind) {
  static auto* const type = new py::exception<Error>(module, name, kind);  // as long as the process lasts
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      PyErr_SetObject(type->ptr(), text_with_paths(error.what()).ptr());
    }
  });
  return *type;
}

/// The three kinds of error (docs/adr/0005-error-kinds.md) by what Python calls their kind.
void bind_errors(py::module_& module) {
  bind_error<core::InputError>(module, "InputError", PyExc_ValueError).doc() =
      "A file, option or value that cannot be used; the message says where and what was expected.";
  bind_error<core::PreconditionError>(module, "PreconditionError", PyExc_ValueError).doc() =
      "A call whose arguments violate its documented requirements; the object is as it was before the call.";
  bind_error<core::NumericalError>(module, "NumericalError", PyExc_ArithmeticError).doc() =
      "The computation broke down numerically; the object is as it was before the call.";
}

/// `Class.__new__(Class)` would hand out an object that nothing has begun, and that ends the process when it is used. Classes made
/// from ours still get theirs by it, and pybind11 sees to it that these call __init__.
py::object new_of(const py::args& arguments, const py::kwargs&) {
  auto* const made = arguments.empty() ? nullptr : reinterpret_cast<PyTypeObject*>(arguments[0].ptr());
  const bool is_derived = made != nullptr && PyType_Check(made) && (made->tp_flags & Py_TPFLAGS_HEAPTYPE) != 0 &&
                          made->tp_new != py::detail::pybind11_object_new;
  if (!is_derived) throw py::type_error("__new__ alone makes no object that could be used: call the class");
  return py::reinterpret_steal<py::object>(py::detail::pybind11_object_new(made, nullptr, nullptr));
}

/// Beside the slot, which calling the class goes by.
void hide_new(py::module_& module) {
  const py::object hidden =
      py::reinterpret_steal<py::object>(PyStaticMethod_New(py::cpp_function(&new_of, py::name("__new__")).ptr()));
  const PyTypeObject* const metaclass = py::detail::get_internals().default_metaclass;
  for (const auto& [name, value] : py::dict(module.attr("__dict__"))) {
    if (Py_TYPE(value.ptr()) != metaclass) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(value.ptr());
    PyDict_SetItemString(type->tp_dict, "__new__", hidden.ptr());
    PyType_Modified(type);
  }
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
  bind_stream(module);
  bind_run(module);
  bind_join(module);
  bind_team(module);
  bind_team_log(module);
  hide_new(module);
}

}  // namespace helixnav::python
