// What low-discrepancy points take off the error of pictures, and of what is seen from afar (means
// over 8 x 8 pixels): points of each pixel that stratify one another over samples and passes, as
// renders have them; points that do so over the samples of a pass and over neighbouring pixels,
// along a Z-shaped curve ("blue noise", Ahmed and Wonka 2020); and independent ones.
// All pixels have as many samples (adaptive = false).
#include <cmath>

#include "benchmarks/quality.h"
#include "kaustik/base/parallel.h"

namespace {

using namespace kaustik;

enum class Points { independent, per_pixel, over_pixels };

/// Place along the Z-shaped curve.
uint32_t z_order(uint32_t x, uint32_t y) {
  uint32_t result = 0;
  for (uint32_t bit = 0; bit < 16; ++bit)
    result |= (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1);
  return result;
}

Sampler sampler_of(Points points, const Pass& pass, const Vec2i& pixel, int width, uint32_t i) {
  const auto x = uint32_t(pixel.x), y = uint32_t(pixel.y), s = pass.samples_per_pixel;
  const uint64_t address = uint64_t(y) * uint64_t(width) + x;
  switch (points) {
    case Points::independent:
      return Sampler::at(pass.seed, pass.index, Stream::camera, address * s + i, 0);
    case Points::over_pixels:
      return Sampler::at(pass.seed, pass.index, Stream::camera, 0, z_order(x, y) * s + i);
    case Points::per_pixel:
      break;
  }
  return Sampler::at(pass.seed, pass.index % replicate_count, Stream::camera, address,
                     pass.index / replicate_count * s + i);
}

/// Adds the mean of a pass to `sum`, row by row.
void add_pass(const Scene& scene, const Integrator& integrator, Points points, const Pass& pass,
              std::vector<Spectrum>& sum) {
  const FilmSettings& film = scene.film();
  SplatBuffer splats = SplatBuffer::nowhere();
  const auto state = integrator.prepare(pass, splats, {}, {});
  parallel_blocks(size_t(film.size.y), 1, [&](size_t begin, size_t end, size_t) {
    for (auto y = int(begin); y < int(end); ++y)
      for (int x = 0; x < film.size.x; ++x)
        for (uint32_t i = 0; i < pass.samples_per_pixel; ++i) {
          Sampler sampler = sampler_of(points, pass, {x, y}, film.size.x, i);
          const Vec2f offset = film.filter.sample(sampler.next_2d());
          SampleSink sink(ComponentSet::all());
          integrator.sample(*state, {float(x) + 0.5f + offset.x, float(y) + 0.5f + offset.y},
                            sampler, sink);
          for (int c = 0; c < component_count; ++c)
            sum[size_t(y) * size_t(film.size.x) + size_t(x)] +=
                sink.radiance(Component(c)) * (1 / float(pass.samples_per_pixel));
        }
  });
}

/// Means over `width`² pixels; those at the end of a row that are left over are left out.
Image coarse(const Image& image, int width) {
  const std::vector<std::string> channels = {"R", "G", "B"};
  Image result(image.width() / width, image.height() / width, channels);
  for (int c = 0; c < int(channels.size()); ++c) {
    const int channel = image.find_channel(channels[size_t(c)]);
    for (int y = 0; y < result.height(); ++y)
      for (int x = 0; x < result.width(); ++x) {
        double sum = 0;
        for (int v = 0; v < width; ++v)
          for (int u = 0; u < width; ++u)
            sum += double(image.at(x * width + u, y * width + v, channel));
        result.at(x, y, c) = float(sum / (width * width));
      }
  }
  return result;
}

Image picture_of(const std::vector<Spectrum>& sum, const Vec2i& size, uint32_t passes) {
  Image image(size.x, size.y, {"R", "G", "B"});
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) = sum[size_t(y) * size_t(size.x) + size_t(x)][size_t(c)] / float(passes);
  return image;
}

/// Error of the picture after so many passes, and of it seen from afar.
struct Errors {
  double of_pixels, from_afar;
};
Errors errors_with(Points points, const Scene& scene, const Integrator& integrator, uint32_t passes,
                   const Image& reference) {
  constexpr int afar = 8;
  const Vec2i size = scene.film().size;
  std::vector<Spectrum> sum(size_t(size.x) * size_t(size.y));
  Pass pass;
  pass.samples_per_pixel = integrator.traits().default_samples_per_pass;
  for (; pass.index < passes; ++pass.index) add_pass(scene, integrator, points, pass, sum);
  const Image picture = picture_of(sum, size, passes);
  return {bench::error_of(picture, reference),
          bench::error_of(coarse(picture, afar), coarse(reference, afar))};
}

void measure(const std::string& name, const std::string& type, uint32_t passes) {
  const auto reference = bench::reference_of(name);
  if (!reference) return;
  Description description = bench::load_shipped(name);
  override_integrator(description, type);
  if (type == "auto") override_property(description, "integrator.adaptive=false");
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  const auto errors = [&](Points points) {
    return errors_with(points, *scene, *integrator, passes, *reference);
  };
  const Errors independent = errors(Points::independent);
  const auto report = [&](const std::string& kind, const Errors& found) {
    bench::report(fmt::format("sampler_{}_{}_{}_passes_{}", name, type, passes, kind),
                  found.of_pixels / independent.of_pixels, "x relative MSE",
                  fmt::format("independent numbers, {:.3g}; of means over 8 x 8 pixels {:.3g} x, "
                              "{:.3g}",
                              independent.of_pixels, found.from_afar / independent.from_afar,
                              independent.from_afar));
  };
  report("per_pixel", errors(Points::per_pixel));
  report("over_pixels", errors(Points::over_pixels));
}

}  // namespace

int main() {
  try {
    for (const char* name : {"cornell_box", "cornell_spheres"}) {
      measure(name, "path", 2);
      for (const uint32_t passes : {4u, 32u}) measure(name, "auto", passes);
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
