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
  types.add_rows(volume_types());
  types.add_rows(camera_types());
  types.add(batch_info());
  types.add_rows(film_types());
  types.add_rows(filter_types());
  for (const TypeInfo& info : sampler_infos()) types.add(info);
  return types;
}

}  // namespace

const TypeInfo& shapegroup_info() {
  static const TypeInfo info{"shape",
                             "shapegroup",
                             "Shapes, or a whole scene with lamps and instances, that appear only "
                             "where an instance places them.",
                             {}};
  return info;
}

const TypeInfo& instance_info() {
  static const TypeInfo info{
      "shape",
      "instance",
      "Places a copy of a shape group.",
      {to_world_parameter("Transform from the group's space to the world.")}};
  return info;
}

const TypeInfo& merge_info() {
  static const TypeInfo info{"shape",
                             "merge",
                             "Holds other shapes and changes nothing. Mitsuba merges similar "
                             "shapes, which is faster there.",
                             {}};
  return info;
}

const TypeInfo& batch_info() {
  static const TypeInfo info{"sensor",
                             "batch",
                             "Holds several sensors; --camera chooses one. Each has the batch's "
                             "sampler and film, with an equal part of the film's width.",
                             {ignored_parameter("shutter_open", ParameterKind::number),
                              ignored_parameter("shutter_close", ParameterKind::number),
                              ignored_parameter("srf", ParameterKind::color)}};
  return info;
}

const TypeTables& scene_types() {
  static const TypeTables types = all_of_scenes();
  return types;
}

}  // namespace kaustik
