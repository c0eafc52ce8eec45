#include "kaustik/scene/scene_cameras.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "kaustik/scene/film_settings.h"

namespace kaustik {
namespace {

bool is_sensor(const Child& child) { return child.object->family == "sensor"; }
bool is_batch(const Child& child) { return is_sensor(child) && child.object->type == "batch"; }

/// The first child of that family; null: there is none.
std::shared_ptr<Object> child_of(const Object& object, const char* family) {
  for (const Child& child : object.children)
    if (child.object->family == family) return child.object;
  return nullptr;
}

/// As wide as one of `parts` pictures side by side.
std::shared_ptr<Object> part_of_film(const Object& film, size_t parts) {
  auto part = std::make_shared<Object>(film);
  int64_t width = FilmSettings().size.x;
  for (const Property& property : film.properties)
    if (property.name == "width")
      if (const auto* given = std::get_if<int64_t>(&property.value)) width = *given;
  std::erase_if(part->properties, [](const Property& property) {
    return property.name == "width" || property.name.starts_with("crop_");
  });
  const int64_t of_part = std::max<int64_t>(1, width / int64_t(parts));
  part->properties.push_back({"width", of_part, film.place});
  return part;
}

class Batch {
 public:
  explicit Batch(const Object& batch) : sampler_(child_of(batch, "sampler")) {
    for (const Child& child : batch.children)
      if (is_sensor(child) || child.object->family == "shape") parts_.push_back(child);
    if (parts_.empty())
      throw Error(ErrorKind::input, "the batch holds no camera", "put sensors into it",
                  batch.place);
    if (const auto film = child_of(batch, "film")) film_ = part_of_film(*film, parts_.size());
  }

  /// Appends its cameras to the children of the scene. A shape that is among them already, which
  /// the batch refers to, is there once.
  void unfold_into(std::vector<Child>& result) const {
    for (size_t i = 0; i < parts_.size(); ++i) {
      const std::string name =
          parts_[i].name.empty() ? "sensor" + std::to_string(i) : parts_[i].name;
      if (is_sensor(parts_[i])) {
        result.push_back({"", camera(*parts_[i].object, name)});
        continue;
      }
      auto shape = std::make_shared<Object>(*parts_[i].object);
      for (Child& child : shape->children)
        if (is_sensor(child)) child.object = camera(*child.object, name);
      const auto known = std::find_if(result.begin(), result.end(), [&](const Child& child) {
        return child.object == parts_[i].object;
      });
      if (known != result.end())
        known->object = shape;
      else
        result.push_back({"", shape});
    }
  }

 private:
  std::shared_ptr<Object> camera(const Object& sensor, const std::string& name) const {
    auto own = std::make_shared<Object>(sensor);
    if (own->id.empty()) own->id = name;
    for (const auto& shared : {film_, sampler_}) {
      if (!shared) continue;
      std::erase_if(own->children,
                    [&](const Child& child) { return child.object->family == shared->family; });
      own->children.push_back({"", shared});
    }
    return own;
  }

  std::vector<Child> parts_;
  std::shared_ptr<Object> film_, sampler_;  ///< null: each has its own
};

}  // namespace

void unfold_batches(Object& scene) {
  if (std::none_of(scene.children.begin(), scene.children.end(), is_batch)) return;
  std::vector<Child> children;
  std::copy_if(scene.children.begin(), scene.children.end(), std::back_inserter(children),
               [](const Child& child) { return !is_batch(child); });
  for (const Child& child : scene.children)
    if (is_batch(child)) Batch(*child.object).unfold_into(children);
  scene.children = std::move(children);
}

std::vector<std::shared_ptr<Object>> cameras_of(const Object& scene) {
  std::vector<std::shared_ptr<Object>> cameras;
  for (const Child& child : scene.children) {
    if (is_sensor(child)) cameras.push_back(child.object);
    if (child.object->family != "shape") continue;
    for (const Child& part : child.object->children)
      if (is_sensor(part)) cameras.push_back(part.object);
  }
  return cameras;
}

void leave_camera(Object& scene, const Object& camera) {
  const auto is_other = [&](const Child& child) {
    return is_sensor(child) && child.object.get() != &camera;
  };
  std::erase_if(scene.children, is_other);
  for (Child& child : scene.children) {
    const std::vector<Child>& parts = child.object->children;
    if (child.object->family != "shape" || std::none_of(parts.begin(), parts.end(), is_other))
      continue;
    child.object = std::make_shared<Object>(*child.object);
    std::erase_if(child.object->children, is_other);
  }
}

}  // namespace kaustik
