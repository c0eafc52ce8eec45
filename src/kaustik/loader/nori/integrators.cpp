#include "kaustik/loader/nori/integrators.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/nori/lights.h"
#include "kaustik/loader/nori/materials.h"
#include "kaustik/loader/object_maker.h"

namespace kaustik::nori {
namespace {

constexpr int64_t direct_light = 2;  ///< segments of a path

std::shared_ptr<Object> started(const char* type, const Object& element) {
  return make_object("integrator", type, element.place);
}

std::shared_ptr<Object> path_of(Given& given) {
  auto path = started("path", given.element());
  const auto depth = given.number({"maxdepth", "depth", "maxpathlength"});
  if (depth && *depth >= 1 && *depth < 1e6) give(*path, "max_depth", int64_t(*depth));
  return path;
}

void remove_lights(Object& object) {
  std::erase_if(object.children,
                [](const Child& child) { return child.object->family == "emitter"; });
}

/// Every surface is white and matt, and `light` is all that there is: then direct light shows what
/// integrators without materials compute.
void add_white_picture(Object& scene, std::shared_ptr<Object> light, const Object& element) {
  remove_lights(scene);
  for (const Child& child : scene.children) {
    if (child.object->family != "shape") continue;
    remove_lights(*child.object);
    std::erase_if(child.object->children,
                  [](const Child& part) { return part.object->family == "bsdf"; });
    put(*child.object, "", matt({1, 1, 1}, child.object->place));
  }
  put(scene, "", std::move(light));
  auto path = started("path", element);
  give(*path, "max_depth", direct_light);
  put(scene, "", std::move(path));
}

/// Nori's radiance Φ cosθ/(4π²d²) is that of white surfaces in the light of a lamp of that power.
void add_simple(Object& scene, Given& given) {
  const Rgb power = given.colour({"energy", "power"}).value_or(Rgb{1, 1, 1});
  const Vec3d position = given.point({"position"}).value_or(Vec3d(0, 0, 0));
  add_white_picture(scene, point_lamp(power, position, given.element().place), given.element());
}

std::string add_visibility(Object& scene, Given& given, Reading& reading) {
  const Object& element = given.element();
  add_white_picture(scene, even_light({1, 1, 1}, false, element.place), element);
  if (element.type == "ao") return {};
  given.skip({"length"});
  const std::string why =
      "all directions count alike in it, up to a distance: here they count by their cosine";
  reading.approximated(element, why);
  return why;
}

/// The methods whose mean is the same here.
std::shared_ptr<Object> same_method(Given& given, Reading& reading) {
  const Object& element = given.element();
  const std::string& type = element.type;
  if (type.starts_with("path") || type.starts_with("vol")) return path_of(given);
  if (type.starts_with("direct")) {
    auto direct = started("path", element);
    give(*direct, "max_depth", direct_light);
    return direct;
  }
  if (type == "whitted" || type == "distributed") return started("raytracing", element);
  if (type.starts_with("progressive") || type.starts_with("ppm") || type.starts_with("sppm"))
    return started("ppm", element);
  if (type.starts_with("photon") || type == "pmap") {
    if (given.number({"photoncount"}) || given.number({"photonradius"}))
      reading.approximated(element, "numbers and radii of photons are Kaustik's own");
    return started("photonmap", element);
  }
  if (type == "bdpt" || type == "vcm") return started(type.c_str(), element);
  return nullptr;
}

}  // namespace

std::string add_integrator(Object& scene, const Object& element, Reading& reading) {
  Given given(element, reading.deviations);
  reading.ignore_parts(element);
  if (element.type == "ao" || element.type == "av") return add_visibility(scene, given, reading);
  if (element.type == "simple") return add_simple(scene, given), std::string();
  if (auto method = same_method(given, reading)) {
    put(scene, "", std::move(method));
    return {};
  }
  std::string why =
      element.type == "normals"
          ? "it shows no light: Kaustik's default does, and layers of the EXR hold normals"
          : "there is no such integrator here: Kaustik's default renders the picture";
  reading.approximated(element, why);
  return why;
}

}  // namespace kaustik::nori
