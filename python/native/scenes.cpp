// Descriptions of scenes: from files, and from and to Python's data.

#include <map>
#include <set>
#include <unordered_map>

#include "bind.h"
#include "kaustik/integrator/description_types.h"
#include "kaustik/loader/mitsuba_writer.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/measuring.h"
#include "kaustik/render/prepared_scene.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/scene/scene_cameras.h"

namespace kaustik::python {

py::object python_value(const Value& value) {
  struct ToPython {
    py::object operator()(bool v) const { return py::bool_(v); }
    py::object operator()(int64_t v) const { return py::int_(v); }
    py::object operator()(double v) const { return py::float_(v); }
    py::object operator()(const std::string& v) const { return py::str(v); }
    py::object operator()(const Vec3d& v) const { return py::make_tuple("point", v.x, v.y, v.z); }
    py::object operator()(const Rgb& v) const { return py::make_tuple("rgb", v.r, v.g, v.b); }
    py::object operator()(const SpectralCurve& v) const {
      return py::make_tuple("spectrum", v.samples);
    }
    py::object operator()(const Transform& v) const { return py::cast(v); }
    py::object operator()(const Untyped& v) const { return py::make_tuple("untyped", v.text); }
    py::object operator()(const std::shared_ptr<const Array>& v) const {
      return py::cast(Buffer{v});
    }
  };
  return std::visit(ToPython(), value);
}

Value native_value(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::int_>(value)) return value.cast<int64_t>();
  if (py::isinstance<py::float_>(value)) return value.cast<double>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<Transform>(value)) return value.cast<Transform>();
  if (py::isinstance<Buffer>(value)) return value.cast<const Buffer&>().array;
  if (py::isinstance<py::tuple>(value)) {
    const auto parts = py::reinterpret_borrow<py::tuple>(value);
    const auto kind = parts[0].cast<std::string>();
    const auto number = [&](size_t i) { return parts[i].cast<double>(); };
    if (kind == "point") return Vec3d(number(1), number(2), number(3));
    if (kind == "rgb") return Rgb{number(1), number(2), number(3)};
    if (kind == "spectrum")
      return SpectralCurve{parts[1].cast<std::vector<std::pair<double, double>>>()};
    if (kind == "untyped") return Untyped{parts[1].cast<std::string>()};
  }
  throw py::type_error("no value of a scene: " + py::repr(value).cast<std::string>());
}

bool has_camera(const Description& description) {
  return !description.is_strict || !cameras_of(*description.scene).empty();
}

void add_camera_if_missing(Description& description) {
  if (has_camera(description)) return;
  const auto camera = std::make_shared<Object>();
  camera->family = "sensor";
  camera->type = "perspective";
  description.scene->children.push_back({"", camera});
}

namespace {

/// Every object of a description once, each before what it holds for the first time.
std::vector<std::shared_ptr<Object>> objects_in_order(const std::shared_ptr<Object>& scene) {
  std::vector<std::shared_ptr<Object>> order, pending = {scene};
  std::set<const Object*> seen;
  while (!pending.empty()) {
    const std::shared_ptr<Object> object = pending.back();
    pending.pop_back();
    if (!seen.insert(object.get()).second) continue;
    order.push_back(object);
    for (size_t i = object->children.size(); i-- > 0;)
      pending.push_back(object->children[i].object);
  }
  return order;
}

py::tuple python_place(const Place& place) {
  return py::make_tuple(place.file ? *place.file : std::string(), place.line, place.column);
}

/// Places of one file share its name.
class Places {
 public:
  Place of(const py::handle& value) {
    const auto [file, line, column] = value.cast<std::tuple<std::string, int, int>>();
    auto& name = names_[file];
    if (!name) name = std::make_shared<const std::string>(file);
    return {name, line, column};
  }

 private:
  std::map<std::string, std::shared_ptr<const std::string>> names_;
};

/// [(family, type, id, place, [(name, value, place)], [(name, index)])]; the first is the scene.
py::list python_objects(const DescribedScene& scene) {
  const auto order = objects_in_order(scene.description->scene);
  std::unordered_map<const Object*, size_t> index;
  for (size_t i = 0; i < order.size(); ++i) index[order[i].get()] = i;
  py::list objects;
  for (const auto& object : order) {
    py::list properties, children;
    for (const Property& p : object->properties)
      properties.append(py::make_tuple(p.name, python_value(p.value), python_place(p.place)));
    for (const Child& child : object->children)
      children.append(py::make_tuple(child.name, index.at(child.object.get())));
    objects.append(py::make_tuple(object->family, object->type, object->id,
                                  python_place(object->place), properties, children));
  }
  return objects;
}

std::vector<std::shared_ptr<Object>> native_objects(const py::list& objects) {
  Places places;
  std::vector<std::shared_ptr<Object>> made(objects.size());
  for (auto& object : made) object = std::make_shared<Object>();
  for (size_t i = 0; i < made.size(); ++i) {
    const auto parts = objects[i].cast<py::tuple>();
    Object& object = *made[i];
    object.family = parts[0].cast<std::string>();
    object.type = parts[1].cast<std::string>();
    object.id = parts[2].cast<std::string>();
    object.place = places.of(parts[3]);
    for (const py::handle& property : parts[4]) {
      const auto p = property.cast<py::tuple>();
      object.properties.push_back({p[0].cast<std::string>(), native_value(p[1]), places.of(p[2])});
    }
    for (const py::handle& child : parts[5]) {
      const auto [name, index] = child.cast<std::pair<std::string, size_t>>();
      // What an object holds comes after it where it is held first: so there is no circle.
      object.children.push_back({name, made.at(index)});
    }
  }
  return made;
}

DescribedScene from_objects(const py::list& objects, std::vector<std::string> sources,
                            std::vector<std::string> warnings, bool is_strict) {
  Description description{native_objects(objects).at(0), std::move(sources), std::move(warnings)};
  description.is_strict = is_strict;
  return {std::make_shared<const Description>(std::move(description)), nullptr, {}};
}

LoadOptions load_options(const std::vector<std::pair<std::string, std::string>>& definitions,
                         bool is_strict) {
  LoadOptions options;
  options.definitions = definitions;
  options.is_strict = is_strict;
  return options;
}

DescribedScene load_file(const std::string& path,
                         const std::vector<std::pair<std::string, std::string>>& definitions,
                         bool is_strict) {
  const py::gil_scoped_release released;
  return {
      std::make_shared<const Description>(load_scene(path, load_options(definitions, is_strict))),
      nullptr,
      {}};
}

DescribedScene load_string(const std::string& text, const std::string& name,
                           const std::string& folder,
                           const std::vector<std::pair<std::string, std::string>>& definitions,
                           bool is_strict) {
  const py::gil_scoped_release released;
  return {std::make_shared<const Description>(
              parse_scene(text, name, folder, load_options(definitions, is_strict))),
          nullptr,
          {}};
}

/// (object, name, value, place): the object by its number in python_objects().
DescribedScene edited(const DescribedScene& scene, const py::list& changes) {
  Places places;
  Description description = copy_of(*scene.description);
  const auto order = objects_in_order(description.scene);
  for (const py::handle& change : changes) {
    const auto parts = change.cast<py::tuple>();
    Object& object = *order.at(parts[0].cast<size_t>());
    const auto name = parts[1].cast<std::string>();
    std::erase_if(object.properties, [&](const Property& p) { return p.name == name; });
    std::erase_if(object.children, [&](const Child& c) { return c.name == name; });
    object.properties.push_back({name, native_value(parts[2]), places.of(parts[3])});
  }
  return {std::make_shared<const Description>(std::move(description)), nullptr, {}};
}

/// The first of `objects` instead of the scene's integrator.
DescribedScene with_integrator(const DescribedScene& scene, const py::list& objects) {
  Description description = copy_of(*scene.description);
  const std::shared_ptr<Object> old = made_integrator(description);
  const std::shared_ptr<Object> made = native_objects(objects).at(0);
  for (Child& child : description.scene->children)
    if (child.object == old) child.object = made;
  return {std::make_shared<const Description>(std::move(description)), nullptr, {}};
}

/// The scene with a meter for its only camera; `lists` are (name, Buffer).
DescribedScene with_meter(const DescribedScene& scene, const std::string& sensor,
                          const py::list& lists) {
  std::vector<Property> properties;
  for (const py::handle& list : lists) {
    const auto parts = list.cast<py::tuple>();
    properties.push_back({parts[0].cast<std::string>(), native_value(parts[1]), {}});
  }
  return {std::make_shared<const Description>(
              measuring(*scene.description, sensor, std::move(properties))),
          nullptr,
          {}};
}

/// Builds it, sharing with another one what is the same; null: with none.
void build(DescribedScene& scene, const DescribedScene* previous) {
  if (scene.built) return;
  const std::shared_ptr<const Scene> shared = previous ? previous->built : nullptr;
  const py::gil_scoped_release released;
  Description description = copy_of(*scene.description);
  std::vector<std::string> warnings;
  const auto keep = [&](const std::string& sentence) { warnings.push_back(sentence); };
  // As a job does: of several cameras it takes one.
  apply_changes(description, {}, {keep, keep});
  add_camera_if_missing(description);
  // Its integrator is checked, too.
  scene.built = prepare_scene(description, {}, false, {{}, keep}, shared).scene;
  scene.warnings = std::move(warnings);
}

}  // namespace

void bind_scenes(py::module_& module) {
  py::class_<DescribedScene>(module, "Scene")
      .def_property_readonly("objects", &python_objects)
      .def_property_readonly("sources",
                             [](const DescribedScene& s) { return s.description->sources; })
      .def_property_readonly("load_warnings",
                             [](const DescribedScene& s) { return s.description->warnings; })
      .def_property_readonly("is_strict",
                             [](const DescribedScene& s) { return s.description->is_strict; })
      .def_property_readonly("has_camera",
                             [](const DescribedScene& s) { return has_camera(*s.description); })
      .def_property_readonly("is_built", [](const DescribedScene& s) { return s.built != nullptr; })
      .def_property_readonly("build_warnings", [](const DescribedScene& s) { return s.warnings; })
      .def("edited", &edited)
      .def("with_integrator", &with_integrator)
      .def("with_meter", &with_meter)
      .def("build", &build, py::arg("previous").none(true))
      // How much of the scene was built for it, rather than shared.
      .def_property_readonly(
          "shapes_built",
          [](const DescribedScene& s) { return s.built ? s.built->build_counts().shapes : 0; })
      .def("to_xml", [](const DescribedScene& s, const std::string& folder) {
        return mitsuba_xml(*s.description, description_types(), folder);
      });
  module.def("load_file", &load_file);
  module.def("load_string", &load_string);
  module.def("scene_from_objects", &from_objects);
  module.attr("measuring_passes") = MeasuringDefaults::passes;
  module.attr("measuring_samples_per_pass") = MeasuringDefaults::samples_per_pass;
}

}  // namespace kaustik::python
