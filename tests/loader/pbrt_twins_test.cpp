// Scenes of pbrt beside the same ones in Mitsuba's XML: the descriptions agree.

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/scene_format.h"
#include "tests/loader/pbrt_support.h"
#include "tests/loader/twin_support.h"

namespace kaustik::pbrt {
namespace {

std::string twin(const std::string& name) {
  return std::string(KAUSTIK_SOURCE_DIR) + "/tests/loader/twins/pbrt/" + name;
}

TEST(PbrtTwins, Bodies) {
  const Description read = load_scene(twin("bodies.pbrt"));
  ASSERT_EQ(read.deviations.size(), 1u);
  EXPECT_TRUE(is_approximated(read, "film", "exposed 1.5 times"));
  const Description wanted = load_scene(twin("bodies.xml"));
  EXPECT_EQ(twins::differences(*read.scene, *wanted.scene, false), 0);
}

TEST(PbrtTwins, DifferencesAreFound) {
  const Description wanted = load_scene(twin("bodies.xml"));
  for (const auto& [name, value] :
       {std::pair<std::string, Value>("radius", 0.71), {"flip_normals", true}}) {
    const Description other = copy_of(wanted);
    Object& sphere = *objects_of(other, "shape")[2];
    remove_property(sphere, name);
    sphere.properties.push_back({name, value, {}});
    EXPECT_EQ(twins::differences(*other.scene, *wanted.scene, true), 1) << name;
  }
}

}  // namespace
}  // namespace kaustik::pbrt
