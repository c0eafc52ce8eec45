#include "kaustik/scene/type_tables.h"

#include "kaustik/geometry/shape.h"
#include "kaustik/light/light.h"
#include "kaustik/material/bsdf.h"
#include "kaustik/material/texture.h"
#include "kaustik/medium/medium.h"
#include "kaustik/scene/camera.h"
#include "kaustik/scene/spectrum_types.h"

namespace kaustik {
namespace {

TypeTables all_of_scenes() {
  TypeTables types;
  types.add_rows(shape_types());
  types.add(shapegroup_info());
  types.add(instance_info());
  types.add(merge_info());
  types.add_rows(bsdf_types());
  types.add_rows(texture_types());
  types.add_rows(spectrum_types());
  types.add_rows(light_types());
  types.add_rows(medium_types());
  types.add_rows(phase_function_types());
  types.add_rows(camera_types());
  types.add_rows(film_types());
  types.add_rows(filter_types());
  for (const TypeInfo& info : sampler_infos()) types.add(info);
  return types;
}

}  // namespace

const TypeInfo& shapegroup_info() {
  static const TypeInfo info{
      "shape",
      "shapegroup",
      "Shapes, or a whole scene with lamps and instances of other groups, that appear only "
      "through instances.",
      {}};
  return info;
}

const TypeInfo& instance_info() {
  static const TypeInfo info{"shape",
                             "instance",
                             "Places a shape group once more.",
                             {to_world_parameter("From the group's space to the world.")}};
  return info;
}

const TypeInfo& merge_info() {
  static const TypeInfo info{
      "shape",
      "merge",
      "Stands for the shapes in it; Mitsuba merges those that are alike, which is faster there.",
      {}};
  return info;
}

const TypeTables& scene_types() {
  static const TypeTables types = all_of_scenes();
  return types;
}

}  // namespace kaustik
