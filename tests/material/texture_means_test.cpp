// A footprint takes no light away and adds none: over many places, lookups with a footprint have
// the mean of those at points, for every registered texture; and mean() tells it.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "kaustik/base/statistics.h"
#include "kaustik/image/image_io.h"
#include "tests/material/bsdf_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

/// Chance that one quick or one long test fails where all is right.
constexpr double means_level = 1e-3;
constexpr float widths[] = {1e-4f, 1e-3f, 3e-3f, 0.01f, 0.03f, 0.1f, 0.3f, 1.0f};  ///< m
constexpr int width_total = int(std::size(widths));

struct SeededTexture {
  std::string name;
  std::vector<std::shared_ptr<const Texture>> seeds;
};

/// A picture whose sizes are no powers of two.
std::string picture_in(const TemporaryFolder& folder) {
  constexpr int width = 37, height = 21;
  Image image(width, height, {"R", "G", "B"});
  std::mt19937 random(1);
  for (int channel = 0; channel < 3; ++channel)
    for (float& value : image.channel(channel)) value = float(random() >> 8) * 0x1p-24f;
  const std::string path = folder.path("picture.exr");
  write_image(image, path);
  return path;
}

/// Every type as it is by itself, and those whose parameters make other patterns.
std::vector<SeededTexture> textures(const TemporaryFolder& folder, int64_t seeds) {
  std::vector<SeededTexture> all;
  const std::string picture = picture_in(folder);
  const auto add = [&](const std::string& name, const std::string& type,
                       std::vector<Property> properties) {
    all.push_back({name, {}});
    const auto row =
        std::find_if(texture_types().begin(), texture_types().end(),
                     [&](const TextureType& known) { return known.info.name == type; });
    for (int64_t seed = 0; seed < seeds; ++seed) {
      std::vector<Property> seeded = properties;
      if (row->info.find("seed")) seeded.push_back(property("seed", seed));
      all.back().seeds.push_back(make_usual_texture(*row, picture, seeded));
    }
  };
  for (const TextureType& type : texture_types()) add(type.info.name, type.info.name, {});
  add("planks", "wood",
      {property("plank_width", 0.08), property("plank_length", 0.7), property("grain", 1.0)});
  add("narrow_planks", "wood", {property("plank_width", 0.003), property("plank_length", 0.01)});
  add("plain_wood", "wood", {property("grain", 0.0), property("ring_width", 0.1)});
  add("small_marble", "marble", {property("scale", 0.02), property("contrast", 0.6)});
  add("rough_noise", "noise", {property("roughness", 1.0), property("octaves", int64_t(2))});
  add("bricks", "tiles",
      {property("offset", 0.5), property("joint", 0.02), property("variation", 1.0)});
  add("tiles_by_uv", "tiles", {property("projection", "uv"), property("tile_width", 0.03)});
  return all;
}

TextureCoordinates random_place(std::mt19937& random) {
  const auto uniform = [&] { return 2 * float(random() >> 8) * 0x1p-24f - 1; };
  constexpr float extent = 20;  // m
  TextureCoordinates at;
  at.position = Vec3f(uniform(), uniform(), uniform()) * extent;
  at.uv = Vec2f(uniform(), uniform()) * extent;
  at.normal = normalize(Vec3f(uniform(), uniform(), uniform() + 0.01f));
  return at;
}

/// Of one texture: what footprints add at the same places, by width, and what is there.
struct Found {
  RunningStatistics at_points, added[width_total];
};

/// `planted`: by so much footprints brighten.
Found look_up(const SeededTexture& texture, int places, double planted) {
  Found found;
  std::mt19937 random(5);
  for (int i = 0; i < places; ++i) {
    const Texture& one = *texture.seeds[size_t(i) % texture.seeds.size()];
    TextureCoordinates at = random_place(random);
    const double point = double(one.eval(at, {})[1]);
    found.at_points.add(point);
    for (int w = 0; w < width_total; ++w) {
      at.width = widths[w];
      at.uv_width = {widths[w], widths[w]};
      found.added[w].add((1 + planted) * double(one.eval(at, {})[1]) - point);
    }
  }
  return found;
}

/// How many of the textures, of so many seeds each, are found to have another mean over a
/// footprint, or to tell another.
int offenders(int places, int64_t seeds, double planted = 0, bool prints = false) {
  const TemporaryFolder folder;
  const std::vector<SeededTexture> all = textures(folder, seeds);
  const double of_one = sidak_level(means_level, int(all.size()) * (width_total + 1));
  int total = 0;
  for (const SeededTexture& texture : all) {
    const Found found = look_up(texture, places, planted);
    const double mean = found.at_points.mean();
    bool offends = z_test_p_value(found.at_points, double(texture.seeds[0]->mean()[1])) < of_one;
    if (prints)
      std::printf("  %-14s %.5f ± %.5f, told %.5f; added:", texture.name.c_str(), mean,
                  found.at_points.standard_error(), double(texture.seeds[0]->mean()[1]));
    for (const RunningStatistics& added : found.added) {
      offends = offends || z_test_p_value(added, 0) < of_one;
      if (prints)
        std::printf(" %+.3f±%.3f", 100 * added.mean() / mean, 100 * added.standard_error() / mean);
    }
    if (prints) std::printf(" %%%s\n", offends ? " !" : "");
    total += offends;
  }
  return total;
}

int texture_total() { return int(textures(TemporaryFolder(), 1).size()); }

TEST(TextureMeans, AreTheSameOverAnyFootprint) {
#ifdef KAUSTIK_SLOW_BUILD
  constexpr int places = 1200;
  constexpr double planted = 0.1;
#else
  constexpr int places = 12000;
  constexpr double planted = 0.03;
#endif
  EXPECT_EQ(offenders(places, 4, 0, true), 0);
  // The twin: all of them a little too bright.
  EXPECT_EQ(offenders(places, 4, planted), texture_total());
}

// Planks of one seed share their years, so there have to be many seeds.
TEST(TextureMeans, AreTheSameOverAnyFootprintLong) {
  constexpr int places = 300000;
  EXPECT_EQ(offenders(places, 200, 0, true), 0);
  EXPECT_EQ(offenders(places, 200, 0.006), texture_total());
}

}  // namespace
}  // namespace kaustik
