#include "kaustik/render/measuring.h"

#include <memory>
#include <utility>

#include "kaustik/scene/scene_cameras.h"

namespace kaustik {

Description measuring(const Description& description, const std::string& sensor,
                      std::vector<Property> lists) {
  Description result = copy_of(description);
  unfold_batches(*result.scene);
  const auto meter = std::make_shared<Object>();
  meter->family = "sensor";
  meter->type = sensor;
  for (Property& list : lists) {
    list.place = place_in(list.name);
    meter->properties.push_back(std::move(list));
  }
  if (const auto cameras = cameras_of(*result.scene); !cameras.empty())
    for (const Child& child : cameras.front()->children)
      if (child.object->family == "medium") meter->children.push_back(child);
  result.scene->children.push_back({"", meter});
  leave_camera(*result.scene, *meter);
  return result;
}

}  // namespace kaustik
