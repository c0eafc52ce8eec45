// A crop window shows what the whole picture shows there: it is planned by the same blocks, with as
// many light paths, and so with the same disks.

#include <cmath>

#include "kaustik/vcm/plan/plans.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

struct Window {
  Vec2i offset, size;
};

FilmSettings film_of(const Vec2i& size, const Window& window) {
  FilmSettings film;
  film.size = size;
  film.crop_offset = window.offset;
  film.crop_size = window.size;
  return film;
}

constexpr int block_size = SeenSurfaces::least_block_size;
const Vec2i whole_size(43, 38);
const std::vector<Window> windows{{{10, 20}, {16, 12}}, {{0, 0}, {1, 1}},    {{42, 37}, {1, 1}},
                                  {{21, 18}, {1, 1}},   {{3, 1}, {40, 3}},   {{40, 0}, {3, 38}},
                                  {{0, 13}, {43, 9}},   {{17, 11}, {26, 27}}};

TEST(PlanWindow, OfAWholePictureIsThatPicture) {
  const PlanWindow window(film_of(whole_size, {{0, 0}, whole_size}), block_size);
  EXPECT_EQ(window.size, whole_size);
  EXPECT_EQ(window.before, Vec2i(0, 0));
}

TEST(PlanWindow, BlocksAreThoseOfTheWholePicture) {
  for (const Window& crop : windows) {
    const PlanWindow window(film_of(whole_size, crop), block_size);
    const Vec2i begin = crop.offset - window.before, end = begin + window.size;
    const BlockGrid grid(window, block_size);
    int pixels = 0;
    for (size_t i = 0; i < grid.size(); ++i) pixels += grid.crop_pixels(i);
    EXPECT_EQ(pixels, crop.size.x * crop.size.y);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_EQ(begin[axis] % block_size, 0);
      EXPECT_TRUE(end[axis] % block_size == 0 || end[axis] == whole_size[axis]);
      // Two blocks on either side, as far as the picture goes.
      const int first = crop.offset[axis] / block_size, margin = 2;
      const int last = (crop.offset[axis] + crop.size[axis] - 1) / block_size;
      EXPECT_LE(begin[axis], std::max(0, (first - margin) * block_size));
      EXPECT_GE(end[axis], std::min(whole_size[axis], (last + margin + 1) * block_size));
    }
  }
}

TEST(LightPathCount, CropWindowsHaveThoseOfTheWholePicture) {
  const Vec2i size(1000, 1000);
  const auto count = [&](const Window& window, uint32_t samples = 4) {
    return light_path_count(film_of(size, window), samples, 0.25f);
  };
  EXPECT_EQ(count({{0, 0}, size}), 1000000u);
  EXPECT_EQ(count({{500, 250}, {250, 250}}), 1000000u);
  EXPECT_EQ(count({{500, 250}, {500, 500}}), 1000000u);
  // Small windows would have to wait for those of a large picture.
  EXPECT_EQ(count({{0, 0}, {100, 100}}), 160000u);
  EXPECT_EQ(count({{0, 0}, {1, 1}}), 1u << 16);
  // Nor does a window need more memory than passes usually take.
  const Vec2i large(8000, 8000);
  EXPECT_EQ(light_path_count(film_of(large, {{0, 0}, {1000, 1000}}), 4, 0.25f), 1u << 21);
  EXPECT_EQ(light_path_count(film_of(large, {{0, 0}, {2000, 2000}}), 4, 0.25f), 4000000u);
}

/// A room with a lamp below its ceiling.
std::string room() {
  return flat("rectangle", scale("0.3, 0.3, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 0.99"),
              diffuse("0, 0, 0") + area_light("10, 10, 10")) +
         "<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/>" +
         diffuse("0.6, 0.6, 0.6") + "</shape>";
}
/// Balls of glass and metal on the floor.
std::string balls() {
  return sphere("0.3, 0, -0.6", 0.35, glass()) +
         sphere("-0.4, 0.3, -0.6", 0.35, "<bsdf type=\"roughconductor\"/>");
}

TestScene shown(int size, const Window& window, const std::string& inside = room() + balls()) {
  const auto integer = [](const char* name, int value) {
    return fmt::format(R"(<integer name="{}" value="{}"/>)", name, value);
  };
  return TestScene(
      R"(<sensor type="perspective"><float name="fov" value="80"/><transform name="to_world">
      <lookat origin="0, -0.95, 0" target="0, 1, -0.3" up="0, 0, 1"/></transform>
      <film type="hdrfilm"><rfilter type="box"/>)" +
      integer("width", size) + integer("height", size) + integer("crop_offset_x", window.offset.x) +
      integer("crop_offset_y", window.offset.y) + integer("crop_width", window.size.x) +
      integer("crop_height", window.size.y) + "</film></sensor>" + inside);
}

/// Largest distance between the probes of a window and those of the whole picture `shift` blocks
/// beside them, m.
double probe_distance(const SeenSurfaces& whole, const SeenSurfaces& part, const Window& window,
                      int shift) {
  const Vec2i first = (window.offset - part.grid().window().before) / block_size;
  const Vec2i blocks = part.grid().count();
  double most = 0;
  for (int y = 0; y < blocks.y; ++y)
    for (int x = 0; x + shift < blocks.x; ++x) {
      const auto& own = part.probes()[part.grid().index_of({x, y})];
      const auto& other = whole.probes()[whole.grid().index_of(first + Vec2i(x + shift, y))];
      EXPECT_EQ(own.found, other.found);
      if (own.found)
        most = std::max(most, double(length(own.vertex.position() - other.vertex.position())));
    }
  return most;
}

TEST(CropWindows, ArePlannedByTheProbesOfTheWholePicture) {
  const int size = 37;
  const SeenSurfaces whole(shown(size, {{0, 0}, {size, size}}).scene());
  for (const Window& window : std::vector<Window>{
           {{10, 20}, {16, 12}}, {{0, 0}, {1, 1}}, {{36, 36}, {1, 1}}, {{33, 3}, {4, 31}}}) {
    const SeenSurfaces part(shown(size, window).scene());
    // Delta events choose at random, so only what is met first has to be the same: no ball here.
    EXPECT_NEAR(part.mean_distance(), whole.mean_distance(), 1e-5f);
    for (int axis = 0; axis < 2; ++axis)
      EXPECT_EQ((window.offset - part.grid().window().before)[axis] % block_size, 0);
  }
  const Window wall{{1, 2}, {14, 9}};
  const SeenSurfaces part(shown(size, wall).scene());
  EXPECT_LT(probe_distance(whole, part, wall, 0), 1e-4);
  EXPECT_GT(probe_distance(whole, part, wall, 1), 0.05) << "a block's shift goes unseen";
}

/// A corner, and a strip from one side to the other.
TEST(CropWindows, AreAsBrightAsTheWholePictureIsThereLong) {
  constexpr int size = 48;
  const std::string inside =
      room() +
      flat("cube", scale("0.3, 0.3, 0.3") + translate("0.2, 0.3, -0.7"), diffuse("0.3, 0.5, 0.3"));
  const TestScene whole = shown(size, {{0, 0}, {size, size}}, inside);
  RenderOptions options, others;
  options.samples = 32;
  others.samples = 64;
  others.seed = 2;
  for (const char* type : {"photonmap", "auto"}) {
    const Passes picture = render(whole, type, "", options);
    for (const Window& window : std::vector<Window>{{{36, 36}, {8, 12}}, {{0, 20}, {size, 8}}}) {
      const Vec2i end = window.offset + window.size;
      const auto is_inside = [&](int x, int y) {
        return x >= window.offset.x && x < end.x && y >= window.offset.y && y < end.y ? 1.0 : 0.0;
      };
      const Comparison there(render(shown(size, window, inside), type, "", others).mean({""}),
                             picture.mean({""}, is_inside));
      expect_near_means(fmt::format("{}, {} x {} from {}, {}", type, window.size.x, window.size.y,
                                    window.offset.x, window.offset.y),
                        there, 0.02, 2 * sharp);
    }
  }
}

}  // namespace
}  // namespace kaustik
