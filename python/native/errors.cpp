// Kaustik's errors become kaustik.Error of the package, with all their problems.
#include "bind.h"
#include "kaustik/base/error.h"

namespace kaustik::python {
namespace {

py::object python_problem(const Problem& problem) {
  const Place& place = problem.place;
  const auto known = [](int number) -> py::object {
    if (number > 0) return py::int_(number);
    return py::none();
  };
  py::object file = py::none();
  if (place.file && !place.file->empty()) file = py::str(*place.file);
  return py::make_tuple(problem.message, problem.remedy, file, known(place.line),
                        known(place.column));
}

void raise(const Error& error) {
  py::list problems;
  for (const Problem& problem : error.problems()) problems.append(python_problem(problem));
  const py::object made =
      py::module_::import("kaustik._errors")
          .attr("error_of")(std::string(error.what()), problems, error.kind() == ErrorKind::system);
  PyErr_SetObject(py::type::handle_of(made).ptr(), made.ptr());
}

}  // namespace

void bind_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      raise(error);
    }
  });
}

}  // namespace kaustik::python
