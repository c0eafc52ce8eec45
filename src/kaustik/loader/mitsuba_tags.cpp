#include "kaustik/loader/mitsuba_tags.h"

#include <algorithm>

namespace kaustik::mitsuba {
namespace {

std::vector<std::string> all_part_tags() {
  std::vector<std::string> tags = object_tags();
  tags.erase(tags.begin());  // scene
  tags.insert(tags.end(), property_tags().begin(), property_tags().end());
  tags.insert(tags.end(), {"transform", "animation", "ref", "alias", "default", "path", "include"});
  return tags;
}

}  // namespace

const std::vector<std::string>& object_tags() {
  static const std::vector<std::string> tags = {
      "scene",   "shape",      "bsdf",    "emitter", "sensor", "film",  "rfilter",
      "sampler", "integrator", "texture", "medium",  "phase",  "volume"};
  return tags;
}

const std::vector<std::string>& property_tags() {
  static const std::vector<std::string> tags = {"boolean", "integer", "float",    "string",
                                                "point",   "vector",  "spectrum", "rgb"};
  return tags;
}

const std::vector<std::string>& transform_tags() {
  static const std::vector<std::string> tags = {"translate", "rotate", "scale", "lookat", "matrix"};
  return tags;
}

const std::vector<std::string>& part_tags() {
  static const std::vector<std::string> tags = all_part_tags();
  return tags;
}

const std::vector<std::string>& file_property_names() {
  static const std::vector<std::string> names = {"filename", "photon_map"};
  return names;
}

bool is_in(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace kaustik::mitsuba
