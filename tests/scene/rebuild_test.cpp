// A scene that is built after another one shares what has not changed, no more and no less, and is
// the scene that would have been built without it.

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "kaustik/base/sampler.h"
#include "kaustik/scene/scene_report.h"
#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::test {
namespace {

const std::string scenes = std::string(KAUSTIK_SOURCE_DIR) + "/scenes/";

std::string named(const std::string& name, const std::string& value) {
  return "<string name=\"" + name + "\" value=\"" + value + "\"/>";
}
std::string moved(const std::string& by) {
  return "<transform name=\"to_world\"><translate value=\"" + by + "\"/></transform>";
}

/// What edits change.
struct Edit {
  std::string camera = "0, 1, 6", color = "0.5", block = "0, 0, 0", instance = "2, 0, 0",
              lamp = "4", width = "64";
};

/// Meshes and pictures of files, a group, an environment, and lamps among which is chosen.
Description house(const Edit& edit = {}) {
  std::string text =
      "<sensor type=\"perspective\"><transform name=\"to_world\"><lookat origin=\"" + edit.camera +
      "\" target=\"0, 1, 0\" up=\"0, 1, 0\"/></transform><film type=\"hdrfilm\"><integer "
      "name=\"width\" value=\"" +
      edit.width + "\"/><integer name=\"height\" value=\"48\"/></film></sensor>";
  text += "<bsdf type=\"diffuse\" id=\"painted\"><texture type=\"bitmap\" name=\"reflectance\">" +
          named("filename", scenes + "gallery_1/pictures/composition.ppm") + "</texture></bsdf>";
  text +=
      "<bsdf type=\"twosided\" id=\"grey\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
      "value=\"" +
      edit.color + "\"/></bsdf></bsdf>";
  text += "<shape type=\"ply\">" + named("filename", scenes + "cornell_box/meshes/floor.ply") +
          "<ref id=\"painted\"/></shape>";
  text += "<shape type=\"ply\">" + named("filename", scenes + "cornell_box/meshes/tall_block.ply") +
          moved(edit.block) + "<ref id=\"grey\"/></shape>";
  text += "<shape type=\"shapegroup\" id=\"g\"><shape type=\"ply\">" +
          named("filename", scenes + "cornell_box/meshes/short_block.ply") +
          "<ref id=\"grey\"/></shape><shape type=\"sphere\"/></shape>";
  text += "<shape type=\"instance\"><ref id=\"g\"/>" + moved(edit.instance) + "</shape>";
  text += "<shape type=\"instance\"><ref id=\"g\"/>" + moved("-3, 0, 1") + "</shape>";
  text += "<shape type=\"disk\">" + moved("0, 3, 1") +
          "<emitter type=\"area\"><rgb name=\"radiance\" value=\"" + edit.lamp +
          "\"/></emitter></shape>";
  text += "<emitter type=\"point\"><point name=\"position\" value=\"1, 2, 1\"/></emitter>";
  text += "<emitter type=\"envmap\">" +
          named("filename", scenes + "gallery_1/pictures/mountain_lake.ppm") + "</emitter>";
  return description_of(text);
}

/// Expects that both are one scene: by rays, by what is where they hit, and by their lights.
void expect_same(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.surface_count(), b.surface_count());
  ASSERT_EQ(a.lights().size(), b.lights().size());
  EXPECT_EQ(a.warnings(), b.warnings());
  EXPECT_EQ(a.tracer().size_in_bytes(), b.tracer().size_in_bytes());
  for (uint32_t i = 0; i < 3000; ++i) {
    Sampler sampler = Sampler::at(1, 0, Stream::light_probe, 0, i);
    const Vec2f u = sampler.next_2d();
    const Ray ray = a.camera().sample_ray({u.x * 64, u.y * 48}, Camera::middle_of_lens());
    const Ray twin = b.camera().sample_ray({u.x * 64, u.y * 48}, Camera::middle_of_lens());
    ASSERT_EQ(ray.direction, twin.direction);
    Hit one, two;
    ASSERT_EQ(a.intersect(ray, one), b.intersect(twin, two));
    for (size_t light = 0; light < a.lights().size(); ++light)
      EXPECT_EQ(a.light_selector().probability(ray.origin + ray.direction, {0, 1, 0}, int(light)),
                b.light_selector().probability(ray.origin + ray.direction, {0, 1, 0}, int(light)));
    for (size_t light = 0; light < a.lights().size(); ++light) {
      const LightSample x = a.lights()[light]->sample_toward(ray.origin, u);
      const LightSample y = b.lights()[light]->sample_toward(ray.origin, u);
      EXPECT_EQ(x.direction, y.direction);
      EXPECT_EQ(x.radiance[1], y.radiance[1]);
      EXPECT_EQ(x.pdf_solid_angle, y.pdf_solid_angle);
      EXPECT_EQ(a.lights()[light]->traits().shape, b.lights()[light]->traits().shape);
    }
    if (one.t == infinity || !a.intersect(ray, one)) continue;
    ASSERT_EQ(one.t, two.t);
    ASSERT_EQ(one.shape, two.shape);
    const SurfacePoint p = a.tracer().surface_point(ray, one);
    const SurfacePoint q = b.tracer().surface_point(ray, two);
    EXPECT_EQ(p.position, q.position);
    EXPECT_EQ(p.ns, q.ns);
    BsdfContext context;
    TextureCoordinates where;
    where.uv = p.uv;
    context.move_to(where, {});
    for (int lane = 0; lane < 4; ++lane)
      EXPECT_EQ(a.surface(p.shape).bsdf->albedo(context, {0, 0, 1}, Lobes::all)[lane],
                b.surface(q.shape).bsdf->albedo(context, {0, 0, 1}, Lobes::all)[lane]);
  }
}

/// Builds the edited house after the first one and without it, and compares them.
BuildCounts counts_after(const Edit& edit) {
  const auto first = build_scene(house());
  const auto second = build_scene(house(edit), first);
  expect_same(*second, *build_scene(house(edit)));
  return second->build_counts();
}

void expect_counts(const BuildCounts& found, const BuildCounts& expected) {
  EXPECT_EQ(found.shapes, expected.shapes);
  EXPECT_EQ(found.pictures, expected.pictures);
  EXPECT_EQ(found.textures, expected.textures);
  EXPECT_EQ(found.bsdfs, expected.bsdfs);
  EXPECT_EQ(found.lights, expected.lights);
  EXPECT_EQ(found.light_tables, expected.light_tables);
  EXPECT_EQ(found.group_structures, expected.group_structures);
  EXPECT_EQ(found.top_structures, expected.top_structures);
  EXPECT_EQ(found.light_selectors, expected.light_selectors);
  EXPECT_EQ(found.light_probings, expected.light_probings);
}

TEST(Rebuild, TheFirstSceneMakesEverything) {
  expect_counts(build_scene(house())->build_counts(), {.shapes = 5,
                                                       .pictures = 2,
                                                       .textures = 1,
                                                       .bsdfs = 5,
                                                       .lights = 3,
                                                       .light_tables = 1,
                                                       .group_structures = 1,
                                                       .top_structures = 1,
                                                       .light_selectors = 1,
                                                       .light_probings = 1});
}

TEST(Rebuild, TheSameSceneMakesNothing) { expect_counts(counts_after({}), {}); }

TEST(Rebuild, ACameraMoveMakesOnlyWhatItsSurroundingsTeach) {
  expect_counts(counts_after({.camera = "1, 2, 6"}), {.light_probings = 1});
  expect_counts(counts_after({.width = "63"}), {.light_probings = 1});
}

/// The bsdf and the one that holds it; lights are seen as before.
TEST(Rebuild, AMaterialEditMakesOnlyThat) {
  expect_counts(counts_after({.color = "0.25"}), {.bsdfs = 2});
}

/// All shapes of the world are in one tree.
TEST(Rebuild, AMeshThatMovesIsReadWithTheTopStructure) {
  expect_counts(counts_after({.block = "0, 0.1, 0"}),
                {.shapes = 1, .lights = 0, .top_structures = 1, .light_probings = 1});
  // The scene has other bounds: its environment needs them, but not its tables.
  expect_counts(
      counts_after({.block = "0, 9, 0"}),
      {.shapes = 1, .lights = 1, .top_structures = 1, .light_selectors = 1, .light_probings = 1});
}

TEST(Rebuild, AnInstanceThatMovesReadsNothing) {
  expect_counts(counts_after({.instance = "2, 0.1, 0"}),
                {.top_structures = 1, .light_probings = 1});
}

TEST(Rebuild, ALampThatChangesIsMade) {
  expect_counts(counts_after({.lamp = "5"}),
                {.lights = 1, .light_selectors = 1, .light_probings = 1});
}

TEST(Rebuild, GoesOnOverManyScenesWhoseFirstOnesAreGone) {
  auto scene = build_scene(house());
  for (const char* place : {"1, 2, 6", "2, 2, 6", "3, 2, 6"}) {
    scene = build_scene(house({.camera = place}), scene);
    expect_counts(scene->build_counts(), {.light_probings = 1});
  }
  expect_same(*scene, *build_scene(house({.camera = "3, 2, 6"})));
}

/// Files that were written just now are read again; so are those that were replaced, however
/// alike.
TEST(Rebuild, FilesThatWereReplacedAreReadAgain) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.obj");
  const auto write = [&](const std::string& to, const char* height) {
    std::ofstream(to) << "v 0 0 0\nv 1 0 0\nv 0 1 " << height << "\nf 1 2 3\n";
  };
  const Description description =
      description_of(std::string(any_camera) + "<shape type=\"obj\">" + named("filename", path) +
                     "</shape><shape type=\"ply\">" +
                     named("filename", scenes + "cornell_box/meshes/floor.ply") + "</shape>");
  const auto height = [](const Scene& scene) { return scene.tracer().shape(0).bounds().max.z; };
  write(path, "0");
  const auto first = build_scene(description);
  const auto again = build_scene(description, first);
  EXPECT_EQ(again->build_counts().shapes, 1);  // too fresh to be relied on
  write(path, "1");
  EXPECT_EQ(height(*build_scene(description, again)), 1);
  const auto time = std::filesystem::last_write_time(path);
  write(folder.path("b.obj"), "2");
  std::filesystem::last_write_time(folder.path("b.obj"), time);
  std::filesystem::rename(folder.path("b.obj"), path);
  EXPECT_EQ(height(*build_scene(description, again)), 2);
  std::filesystem::remove(path);
  const auto without = build_scene(description, again);
  EXPECT_EQ(without->warnings().size(), 1u);
  EXPECT_NE(height(*without), 2);
}

std::shared_ptr<Object> described_object(std::string family, std::string type,
                                         std::vector<Property> properties) {
  return std::make_shared<Object>(Object{
      std::move(family), std::move(type), "", std::move(properties), {}, place_in("program")});
}

TEST(Rebuild, BuffersAreKnownByTheirContents) {
  const auto described = [](float height) {
    const Value positions(Array::of<float>({3, 3}, {0, 0, 0, 1, 0, 0, 0, 1, height}));
    const Value faces(Array::of<int32_t>({1, 3}, {0, 1, 2}));
    Description description = description_of(any_camera);
    description.scene->children.push_back(
        {"",
         described_object("shape", "mesh", {{"positions", positions, {}}, {"faces", faces, {}}})});
    return description;
  };
  const auto first = build_scene(described(0));
  EXPECT_EQ(build_scene(described(0), first)->build_counts().shapes, 0);
  EXPECT_EQ(build_scene(described(0.5f), first)->build_counts().shapes, 1);
}

/// What was odd about a picture is told again, and counts against the memory for pictures again.
TEST(Rebuild, SharedPicturesAreToldAndCountedAgain) {
  const auto described = [](float exposure) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Value data(Array::of<float>({2, 2}, {1, nan, -2, 3}));
    Description description = description_of(any_camera);
    description.scene->children.push_back(
        {"", described_object("emitter", "envmap", {{"data", data, {}}})});
    description.scene->children.push_back(
        {"", described_object("emitter", "constant", {{"radiance", Value(double(exposure)), {}}})});
    return description;
  };
  const auto first = build_scene(described(1));
  ASSERT_EQ(first->warnings().size(), 1u);
  EXPECT_EQ(build_scene(described(2), first)->warnings(), first->warnings());
  BuildOptions narrow;
  narrow.texture_memory_bytes = 10;
  EXPECT_THROW(build_scene(described(2), first, narrow), Error);
}

/// A scene goes on being traced while others are made of its parts and thrown away.
TEST(Rebuild, APreviousSceneMayStillBeInUse) {
  const auto first = build_scene(house());
  std::vector<Ray> rays;
  std::vector<float> distances;
  for (uint32_t i = 0; i < 500; ++i) {
    Sampler sampler = Sampler::at(2, 0, Stream::light_probe, 0, i);
    const Vec2f u = sampler.next_2d();
    rays.push_back(first->camera().sample_ray({u.x * 64, u.y * 48}, Camera::middle_of_lens()));
    Hit hit;
    distances.push_back(first->intersect(rays.back(), hit) ? hit.t : infinity);
  }
  std::atomic<bool> done = false;
  std::atomic<int> wrong = 0, rounds = 0;
  std::thread renders([&] {
    do {
      for (size_t i = 0; i < rays.size(); ++i) {
        Hit hit;
        wrong += (first->intersect(rays[i], hit) ? hit.t : infinity) != distances[i];
      }
      ++rounds;
    } while (!done);
  });
  std::shared_ptr<const Scene> last = first;
  for (int i = 1; i < 8; ++i)
    last = build_scene(house({.instance = "2, 0." + std::to_string(i) + ", 0"}), last);
  done = true;
  renders.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(rounds, 0);
  expect_same(*last, *build_scene(house({.instance = "2, 0.7, 0"})));
}

}  // namespace
}  // namespace kaustik::test
