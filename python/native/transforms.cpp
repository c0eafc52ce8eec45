#include <array>
#include <stdexcept>

#include "bind.h"
#include "kaustik/base/transform.h"

namespace kaustik::python {
namespace {

using Rows = std::array<double, 16>;

void fill(double (&rows)[4][4], const Rows& numbers) {
  for (size_t i = 0; i < 16; ++i) rows[i / 4][i % 4] = numbers[i];
}

Transform from_rows(const Rows& numbers) {
  double rows[4][4];
  fill(rows, numbers);
  return Transform(rows);
}

Transform from_both(const Rows& numbers, const Rows& inverse_numbers) {
  double rows[4][4], inverse[4][4];
  fill(rows, numbers);
  fill(inverse, inverse_numbers);
  return Transform(rows, inverse);
}

py::tuple rows_of(const Transform& transform) {
  py::tuple rows(16);
  for (size_t i = 0; i < 16; ++i) rows[i] = transform.at(int(i / 4), int(i % 4));
  return rows;
}

using Three = std::array<double, 3>;
Vec3d vector_of(const Three& v) { return {v[0], v[1], v[2]}; }

}  // namespace

void bind_transforms(py::module_& module) {
  py::class_<Transform>(module, "Transform")
      .def(py::init<>())
      .def(py::init(&from_rows))
      .def(py::init(&from_both))
      .def_static("translate", [](const Three& v) { return Transform::translate(vector_of(v)); })
      .def_static("scale", [](const Three& v) { return Transform::scale(vector_of(v)); })
      .def_static("rotate",
                  [](const Three& axis, double degrees) {
                    return Transform::rotate(vector_of(axis), degrees);
                  })
      .def_static("look_at",
                  [](const Three& origin, const Three& target, const Three& up) {
                    return Transform::look_at(vector_of(origin), vector_of(target), vector_of(up));
                  })
      .def("__matmul__", [](const Transform& a, const Transform& b) { return a * b; })
      .def("__eq__", [](const Transform& a, const Transform& b) { return a == b; })
      .def("inverse", &Transform::inverse)
      .def_property_readonly("rows", &rows_of)
      .def(py::pickle(
          [](const Transform& t) { return py::make_tuple(rows_of(t), rows_of(t.inverse())); },
          [](const py::tuple& state) {
            return from_both(state[0].cast<Rows>(), state[1].cast<Rows>());
          }));
}

}  // namespace kaustik::python
