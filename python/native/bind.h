#pragma once
// The parts of the module, each of which adds its classes and functions. What they offer is for
// python/kaustik alone, which is the interface that users see.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <vector>

#include "kaustik/base/array.h"
#include "kaustik/base/parameters.h"
#include "kaustik/image/image.h"
#include "kaustik/scene/description.h"
#include "kaustik/scene/scene.h"

namespace kaustik::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_arrays(py::module_& module);
void bind_transforms(py::module_& module);
void bind_types(py::module_& module);
void bind_scenes(py::module_& module);
void bind_images(py::module_& module);
void bind_films(py::module_& module);
void bind_jobs(py::module_& module);
void bind_photons(py::module_& module);
void bind_views(py::module_& module);

/// Numbers for Python, which it sees by the buffer protocol; Python's `Buffer`.
struct Buffer {
  std::shared_ptr<const Array> array;
};

/// A scene as it was described; Python's `Scene`.
struct DescribedScene {
  std::shared_ptr<const Description> description;
  std::shared_ptr<const Scene> built;  ///< null: not yet
  std::vector<std::string> warnings;   ///< of building it
};

/// Whether it can be looked at. One that is not read strictly can: Mitsuba's camera stands for its
/// own.
bool has_camera(const Description& description);
/// What nobody looks at needs no camera, and gets one that stands for it while it is built.
void add_camera_if_missing(Description& description);

/// Python's value of a property, and back: bool, int, float and str are themselves, as are Buffer
/// and Transform; others are tuples that begin with "point", "rgb", "spectrum" or "untyped". Throws
/// TypeError for others.
py::object python_value(const Value& value);
Value native_value(const py::handle& value);

}  // namespace kaustik::python
