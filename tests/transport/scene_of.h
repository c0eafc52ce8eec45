#pragma once
// Scenes from text for the tests of this room.

#include <memory>
#include <string>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/scene/scene.h"

namespace kaustik::test {

/// The objects, and a camera that looks at nothing in particular.
inline std::shared_ptr<const Scene> scene_of(const std::string& objects) {
  return build_scene(parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>" + objects + "</scene>", "test.xml",
      ""));
}

}  // namespace kaustik::test
