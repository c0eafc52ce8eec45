#include "kaustik/loader/nori/scenes.h"

#include "kaustik/base/error.h"
#include "kaustik/loader/nori/cameras.h"
#include "kaustik/loader/nori/integrators.h"
#include "kaustik/loader/nori/lights.h"
#include "kaustik/loader/nori/materials.h"
#include "kaustik/loader/nori/meshes.h"
#include "kaustik/loader/object_maker.h"

namespace kaustik::nori {
namespace {

/// Those of which a scene has one.
struct SingleParts {
  const Object *camera = nullptr, *sampler = nullptr, *integrator = nullptr;
};

const Object** place_for(const std::string& family, SingleParts& parts) {
  if (family == "camera") return &parts.camera;
  if (family == "sampler") return &parts.sampler;
  if (family == "integrator") return &parts.integrator;
  return nullptr;
}

/// Returns false for what no scene has.
bool add_world_part(Object& scene, const Object& part, Reading& reading) {
  std::shared_ptr<Object> made;
  if (part.family == "mesh" || part.family == "shape")
    made = shape_of(part, reading);
  else if (part.family == "emitter" || part.family == "luminaire")
    made = lamp_of(part, reading);
  else
    return false;
  if (made) put(scene, "", std::move(made));
  return true;
}

}  // namespace

ReadScene scene_of(const Object& element, Reading& reading) {
  ReadScene read{make_object("scene", "", element.place), {}};
  const Given of_scene(element, reading.deviations);
  SingleParts parts;
  for (const Child& child : element.children) {
    const Object& part = *child.object;
    if (const Object** single = place_for(part.family, parts)) {
      if (*single)
        reading.ignored(part, "the scene has one already");
      else
        *single = &part;
    } else if (!add_world_part(*read.scene, part, reading)) {
      reading.ignored(part, "there is no such part of a scene here");
    }
  }
  if (!parts.camera)
    throw Error(ErrorKind::input, "the scene has no camera",
                "add <camera type=\"perspective\"> … </camera>", element.place);
  put(*read.scene, "", sensor_of(*parts.camera, parts.sampler, reading));
  if (parts.integrator) read.difference = add_integrator(*read.scene, *parts.integrator, reading);
  return read;
}

std::shared_ptr<Object> ball_of(const Object& bsdf, Reading& reading) {
  auto scene = make_object("scene", "", bsdf.place);
  auto ball = make_object("shape", "sphere", bsdf.place);
  put(*ball, "", bsdf_of(bsdf, reading));
  put(*scene, "", std::move(ball));
  put(*scene, "", make_object("sensor", "perspective", bsdf.place));
  return scene;
}

}  // namespace kaustik::nori
