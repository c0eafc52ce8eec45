#pragma once
// What tests of regions render: made-up passes of a film, and passes of a small scene.

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "kaustik/image/photometry.h"
#include "kaustik/render/checkpoint.h"
#include "kaustik/render/session.h"
#include "tests/render/glass_ball_scene.h"
#include "tests/support/measure.h"
#include "tests/support/pass_of.h"
#include "tests/support/scene_text.h"

namespace kaustik::test {

// Tiles of the picture are cut, and so are those of the regions, which overlap.
inline constexpr int picture_width = 37, picture_height = 22;
inline constexpr PixelRegion first_region{7, 9, 21, 8}, second_region{12, 3, 20, 9};

inline FilmSettings settings_of_film(int w = picture_width, int h = picture_height) {
  FilmSettings settings;
  settings.size = settings.crop_size = {w, h};
  return settings;
}

using RegionPixels = std::vector<PassPixel>;

/// Noise of each pixel, and noise that all pixels of a pass share as they share photons.
class MadeUpPasses {
 public:
  explicit MadeUpPasses(uint32_t seed, float shared = 0) : generator_(seed), shared_(shared) {}
  RegionPixels next(size_t count) {
    std::normal_distribution<float> normal(0, 1);
    const float off = shared_ * normal(generator_);
    RegionPixels pixels(count);
    for (PassPixel& pixel : pixels) {
      const float value = 3 + off + normal(generator_);
      pixel.radiance[size_t(Component::direct)] = {value, value, value, 0};
      pixel.radiance[size_t(Component::caustic)] = {0.5f * value, 0, 0.125f, 0};
      pixel.first_hit.depth = value;
    }
    return pixels;
  }

 private:
  std::mt19937 generator_;
  float shared_;
};

inline Pass regional_pass(const Film& film, const PixelRegion& region, uint32_t stage) {
  Pass pass = film.next_regional_pass(region, stage);
  pass.samples_per_pixel = 1;
  return pass;
}

inline void add_regional(Film& film, const PixelRegion& region, const RegionPixels& pixels,
                         uint32_t stage) {
  film.add_regional_pass(region, pass_of(pixels, {region.width, region.height}),
                         regional_pass(film, region, stage));
}

/// A film, and the same passes pixel by pixel.
struct FilmAndPasses {
  Film film{settings_of_film(), {ComponentSet::all()}};
  struct Value {
    uint32_t replicate;
    float value;
  };
  std::vector<std::vector<Value>> values =
      std::vector<std::vector<Value>>(size_t(picture_width) * picture_height);

  void add_whole(uint32_t index, const RegionPixels& pixels) {
    film.add_pass(pass_of(pixels, {picture_width, picture_height}), index);
    for (size_t i = 0; i < pixels.size(); ++i) values[i].push_back(value_of(index, pixels[i]));
  }
  void add(const PixelRegion& region, const RegionPixels& pixels, uint32_t stage) {
    const uint32_t index = regional_pass(film, region, stage).index;
    add_regional(film, region, pixels, stage);
    for (size_t i = 0; i < pixels.size(); ++i) {
      const size_t x = size_t(region.x) + i % size_t(region.width);
      const size_t y = size_t(region.y) + i / size_t(region.width);
      values[y * picture_width + x].push_back(value_of(index, pixels[i]));
    }
  }
  static Value value_of(uint32_t index, const PassPixel& pixel) {
    const Spectrum sum =
        pixel.radiance[size_t(Component::direct)] + pixel.radiance[size_t(Component::caustic)];
    return {index % replicate_count, photopic(Vec3f(sum[0], sum[1], sum[2]))};
  }
};

inline FilmAndPasses film_with_regions(uint32_t seed = 1) {
  FilmAndPasses result;
  MadeUpPasses passes(seed);
  for (uint32_t i = 0; i < 5; ++i)
    result.add_whole(i, passes.next(size_t(picture_width) * picture_height));
  for (int i = 0; i < 7; ++i)
    result.add(first_region, passes.next(size_t(first_region.pixel_count())), 5);
  for (int i = 0; i < 3; ++i)
    result.add(second_region, passes.next(size_t(second_region.pixel_count())), 5);
  return result;
}

inline float channel_at(const Image& image, int x, int y, const std::string& channel) {
  return image.at(x, y, image.find_channel(channel));
}

inline const TestScene& ball() {
  static const TestScene scene(glass_ball_scene(24));
  return scene;
}

inline std::unique_ptr<Integrator> integrator_of(const std::string& type,
                                                 const std::string& parameters = "") {
  return quick_integrator(ball(), type, parameters);
}

inline constexpr PixelRegion floor_region{5, 12, 13, 9};

inline SessionSettings refined_settings(uint32_t passes, std::vector<RegionRequest> regions = {},
                                        uint32_t first = 0) {
  SessionSettings settings;
  settings.seed = 5;
  settings.first_pass = first;
  settings.passes = passes;
  settings.samples_per_pass = 2;
  settings.regions = std::move(regions);
  return settings;
}

inline Film refined_film(const Integrator& integrator, const SessionSettings& settings) {
  Session session(ball().scene(), integrator, settings);
  session.run();
  return session.film();
}

inline std::vector<uint8_t> film_bytes(const Film& film) { return checkpoint_bytes({}, film); }

}  // namespace kaustik::test
