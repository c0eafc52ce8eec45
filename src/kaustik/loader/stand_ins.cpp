#include "kaustik/loader/stand_ins.h"

#include <algorithm>

#include "kaustik/loader/object_maker.h"

namespace kaustik {

std::shared_ptr<Object> missing_texture(const Place& place) {
  auto checker = make_object("texture", "checkerboard", place);
  give(*checker, "color0", Rgb{0.8, 0, 0.8});
  give(*checker, "color1", Rgb{0.1, 0.1, 0.1});
  give(*checker, "to_uv", Transform::scale({8, 8, 1}));
  return checker;
}

std::shared_ptr<Object> missing_mesh(const Bounds3f& box, const Transform& to_world,
                                     const Place& place) {
  auto cube = make_object("shape", "cube", place);
  const Vec3f middle = center(box), half = (box.max - box.min) * 0.5f;
  // Flat ones get a thickness, for no factor may be zero.
  const float least = std::max(1e-6f, 1e-4f * std::max({half.x, half.y, half.z}));
  const Vec3d size(std::max(half.x, least), std::max(half.y, least), std::max(half.z, least));
  give(*cube, "to_world",
       to_world * Transform::translate({middle.x, middle.y, middle.z}) * Transform::scale(size));
  auto bsdf = make_object("bsdf", "diffuse", place);
  give(*bsdf, "reflectance", Rgb{0.8, 0, 0.8});
  put(*cube, "", bsdf);
  return cube;
}

}  // namespace kaustik
