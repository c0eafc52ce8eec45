// A scene of Nori beside the same one in Mitsuba's XML: the descriptions agree.

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/scene_format.h"
#include "tests/loader/nori_support.h"
#include "tests/loader/twin_support.h"

namespace kaustik::nori {
namespace {

std::string nori_twin(const std::string& name) {
  return std::string(KAUSTIK_SOURCE_DIR) + "/tests/loader/twins/nori/" + name;
}

TEST(NoriTwins, Room) {
  const Description read = load_scene(nori_twin("room.xml"));
  EXPECT_TRUE(read.deviations.empty()) << read.deviations.front().what;
  const Description wanted = load_scene(nori_twin("room_twin.xml"));
  EXPECT_EQ(twins::differences(*read.scene, *wanted.scene, false), 0);
}

TEST(NoriTwins, DifferencesAreFound) {
  const Description wanted = load_scene(nori_twin("room_twin.xml"));
  const Description other = copy_of(wanted);
  Object& lamp = *objects_of(other, "emitter")[0];
  remove_property(lamp, "intensity");
  lamp.properties.push_back({"intensity", Rgb{1, 0, 2.001}, {}});
  EXPECT_EQ(twins::differences(*other.scene, *wanted.scene, true), 1);
}

}  // namespace
}  // namespace kaustik::nori
