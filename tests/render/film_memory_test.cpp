// What films, passes and splats take: measured for every integrator beside what check_film_memory()
// expects.

#include "kaustik/render/film_memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kaustik/base/memory.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/rounded_line.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

constexpr int side = 48;
/// What a pixel may take, with its pass and splats.
constexpr double most_bytes = 320;

/// A glass ball over a floor: every component but media.
const TestScene& ball_scene() {
  static const TestScene scene(
      camera("0, -4, 2", "0, 0, 0.5", 45, side) + flat("rectangle", scale("3"), diffuse("0.5")) +
      sphere("0, 0, 0.6", 0.6, glass()) +
      flat("rectangle", scale("0.5") + rotate("1, 0, 0", 180) + translate("0, 0, 3"),
           area_light("9")));
  return scene;
}

struct Measured {
  double film = 0, rendering = 0;
  double luminances = 0;  ///< what these take at least
};

/// Of the luminances of replicates with one pass each, bytes a pixel: they are rounded to
/// `luminance_bits` places below the geometric mean of those of their tile that are not zero, so
/// they have so many on average.
double bytes_of_luminances(const Film& film) {
  double bits = 0;
  for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
    for (size_t r = 0; r < replicate_count; ++r)
      if (film.sum(pixel, film.numbers().replicate_luminances + r) != 0) bits += luminance_bits;
  return bits / 8 / double(film.pixel_count());
}

Measured measured(const Integrator& integrator, bool layers) {
  SessionSettings settings;
  settings.seed = 3;
  settings.passes = replicate_count;
  settings.samples_per_pass = 1;
  settings.layers = layers;
  Session session(ball_scene().scene(), integrator, settings);
  const SessionReport report = session.run();
  EXPECT_EQ(report.film_bytes, session.film().bytes());
  constexpr double pixels = side * side;
  return {double(report.film_bytes) / pixels, double(report.rendering_bytes) / pixels,
          bytes_of_luminances(session.film())};
}

TEST(FilmMemory, IsBoundedForAllIntegrators) {
  std::printf(
      "bytes a pixel after 16 passes, with layers and without: film; with pass and splats; "
      "expected\n");
  for (const IntegratorType& type : integrator_types()) {
    const std::string name = type.info.name;
    SCOPED_TRACE(name);
    const std::string parameters =
        name == "photonmap"
            ? set("global_photons", 2000) + set("caustic_photons", 2000) + set("cache_samples", 16)
            : "";
    const auto integrator = ball_scene().integrator(name, parameters);
    std::printf("  %-12s", name.c_str());
    for (const bool layers : {true, false}) {
      const Measured is = measured(*integrator, layers);
      const FilmMemory expected =
          expected_film_memory(FilmLayers::of(*integrator, layers), integrator->traits().splats);
      std::printf("  %5.1f %5.1f %5.1f", is.film, is.rendering, expected.rendering());
      EXPECT_LE(is.rendering, most_bytes);
      EXPECT_LE(is.film, expected.film);
      EXPECT_LE(is.rendering, expected.rendering());
      // Nothing is forgotten.
      EXPECT_GT(is.luminances, 0);
      EXPECT_GE(is.film, is.luminances);
    }
    std::printf("\n");
  }
}

/// Bytes a pixel of a scene that ships, beside what is foreseen of them.
void expect_within_bound(const std::string& scene_name, const std::string& type, int size,
                         uint32_t passes) {
  SCOPED_TRACE(scene_name + ", " + type);
  Description description =
      load_scene(KAUSTIK_SOURCE_DIR "/scenes/" + scene_name + "/" + scene_name + ".xml");
  override_integrator(description, type);
  for (const char* side_of : {"film.width=", "film.height="})
    override_property(description, side_of + std::to_string(size));
  if (type == "photonmap")
    for (const char* few : {"integrator.global_photons=20000", "integrator.caustic_photons=20000"})
      override_property(description, few);
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  SessionSettings settings;
  settings.passes = passes;
  settings.samples_per_pass = 1;
  Session session(*scene, *integrator, settings);
  const SessionReport report = session.run();
  const double pixels = double(size) * size, film = double(report.film_bytes) / pixels,
               rendering = double(report.rendering_bytes) / pixels;
  const FilmMemory expected =
      expected_film_memory(FilmLayers::of(*integrator), integrator->traits().splats);
  std::printf("  %-16s %-10s %5.1f %5.1f, foreseen %5.1f %5.1f\n", scene_name.c_str(), type.c_str(),
              film, rendering, expected.film, expected.rendering());
  EXPECT_LE(film, expected.film);
  EXPECT_LE(rendering, expected.rendering());
  EXPECT_LE(rendering, most_bytes);
}

/// The scene that takes most. Pictures this small have more detail in each tile than larger ones.
TEST(FilmMemory, IsBoundedInTheMuseum) {
  expect_within_bound("museum", "path", 48, 16);
  expect_within_bound("museum", "vcm", 48, 8);
}

/// Components that may come but do not take nothing: what only one brings is a fraction of what all
/// bring.
TEST(FilmMemory, ComponentsThatDoNotComeTakeNothing) {
  ComponentSet one;
  one.add(Component::direct);
  FilmSettings settings;
  settings.size = settings.crop_size = {side, side};
  Film few(settings, {one}), may(settings, {ComponentSet::all()}),
      all(settings, {ComponentSet::all()});
  for (uint32_t pass = 0; pass < 4; ++pass) {
    PassTiles tiles({side, side});
    const auto pixels = std::make_unique<PassTiles::Pixels>();
    for (size_t i = 0; i < pixels->size(); ++i)
      (*pixels)[i].radiance[size_t(Component::direct)] = Spectrum(0.1f * float(i + pass));
    for (size_t tile = 0; tile < tiles.tiles().count(); ++tile) tiles.store(tile, *pixels);
    few.add_pass(tiles, pass);
    may.add_pass(tiles, pass);
    for (size_t i = 0; i < pixels->size(); ++i)
      for (int c = 0; c < component_count; ++c)
        (*pixels)[i].radiance[size_t(c)] = (*pixels)[i].radiance[size_t(Component::direct)];
    for (size_t tile = 0; tile < tiles.tiles().count(); ++tile) tiles.store(tile, *pixels);
    all.add_pass(tiles, pass);
  }
  EXPECT_EQ(few.bytes(), may.bytes());
  EXPECT_LT(may.bytes(), all.bytes() - side * side * 3 * (component_count - 1));
}

/// All that is allocated is what the figures say: of a tile's capacities and of the tables.
TEST(FilmMemory, PassesTakeWhatTheyHold) {
  PassTiles pass({3 * PictureTiles::side, PictureTiles::side});
  const size_t empty = pass.bytes();
  const auto pixels = std::make_unique<PassTiles::Pixels>();
  for (PassPixel& pixel : *pixels) {
    pixel.radiance[2] = {1, 2, 3, 0};
    pixel.samples = 4;
  }
  pass.store(1, *pixels);
  EXPECT_EQ(pass.bytes(), empty + 4 * sizeof(float));
  (*pixels)[77].radiance[2].set(1, 5);
  pass.store(1, *pixels);
  EXPECT_EQ(pass.bytes(), empty + (3 + PictureTiles::pixels) * sizeof(float));
  PassTiles::Pixels read;
  pass.load(1, read);
  for (size_t i = 0; i < read.size(); ++i) {
    ASSERT_EQ(read[i].radiance[2], Spectrum(1, i == 77 ? 5 : 2, 3, 0));
    ASSERT_EQ(read[i].samples, 4u);
  }
  pass.load(2, read);
  EXPECT_EQ(read[5].samples, 0u);
  EXPECT_EQ(pass.fewest_samples(), 0u);
  pass.clear();
  EXPECT_EQ(pass.bytes(), empty);
}

TEST(FilmMemory, ComponentsThatNobodyAskedForTakeNothing) {
  ComponentSet one, two;
  one.add(Component::direct);
  two = one;
  two.add(Component::caustic);
  const FilmMemory of_one = expected_film_memory({one}, true),
                   of_two = expected_film_memory({two}, true);
  EXPECT_LT(of_one.film, of_two.film);
  EXPECT_LT(of_one.rendering(), of_two.rendering());
  EXPECT_LT(of_one.image, of_two.image);
  FilmLayers none{two};
  none.in_images = false;
  EXPECT_LT(expected_film_memory(none, true).film, 0.5 * of_two.film);
  EXPECT_EQ(expected_film_memory(none, true).image, 3 * sizeof(float));
  // Displays ask for the light of lamps, and which share of a pixel they have.
  none.components.add(Component::emission);
  EXPECT_EQ(expected_film_memory(none, true).image, 7 * sizeof(float));
}

/// What is needed, what there is, and what to do.
TEST(FilmMemory, PicturesTooLargeAreRefused) {
  const FilmLayers layers{ComponentSet::all(), true};
  const auto refusal = [&](int width, int height) -> std::string {
    FilmSettings settings;
    settings.size = settings.crop_size = {width, height};
    try {
      check_film_memory(settings, layers, true);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  // As large as the memory, and a little larger.
  const double pixels = double(physical_memory_bytes()) / expected_film_memory(layers, true).peak();
  constexpr int width = 16 * 256;
  const int rows = int(pixels / width / 16) * 16;
  if (int64_t(rows + 16) * width > max_image_pixels) GTEST_SKIP() << "this machine is too large";
  EXPECT_EQ(refusal(width, rows), "");
  const std::string text = refusal(width, rows + 16);
  for (const char* part : {"is too large here: it needs about", "GB, and this machine has",
                           "film.layers=none", "kaustik stitch"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_NE(refusal(30000, 30000).find("at most 500000000 are possible"), std::string::npos);
}

TEST(FilmMemory, RegionsCountBesideThePicture) {
  FilmSettings settings;
  const FilmLayers layers{ComponentSet::all()};
  const FilmMemory memory = expected_film_memory(layers, false);
  // The picture takes half of what there is, so regions of a sum over the other half don't fit.
  const double pixels = 0.5 * double(physical_memory_bytes()) / memory.peak();
  const int side_of_half = int(std::sqrt(pixels)) / PictureTiles::side * PictureTiles::side;
  settings.size = settings.crop_size = {side_of_half, side_of_half};
  if (int64_t(side_of_half) * side_of_half > max_image_pixels) GTEST_SKIP() << "too much memory";
  const double shares = memory.peak() / memory.film;  // of the picture, that fill the other half
  const std::vector<PixelRegion> one = {{0, 0, side_of_half, side_of_half}};
  EXPECT_NO_THROW(check_film_memory(settings, layers, false));
  EXPECT_NO_THROW(check_region_memory(settings, layers, false, {}));
  std::vector<PixelRegion> regions(size_t(0.9 * shares), one[0]);
  EXPECT_NO_THROW(check_region_memory(settings, layers, false, regions));
  regions.resize(size_t(1.1 * shares) + 1, one[0]);
  EXPECT_THROW(check_region_memory(settings, layers, false, regions), Error);
}

}  // namespace
}  // namespace kaustik
