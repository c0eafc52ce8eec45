#include "kaustik/render/preview.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/make_integrator.h"

namespace kaustik {
namespace {

/// That it takes at most, about.
constexpr double most_samples = 1 << 16;

}  // namespace

Image preview_picture(const Scene& scene, uint64_t seed, const std::stop_token& stop) {
  const FilmSettings& film = scene.film();
  const Vec2i size = film.crop_size;
  Image image(size.x, size.y, {"R", "G", "B"});
  std::vector<std::string> warnings;
  const auto path =
      make_integrator_alone(Object{"integrator", "path", "", {}, {}, {}}, scene, warnings);
  SplatBuffer nowhere({{1, 1}, {0, 0}, {1, 1}, {}, 0}, ComponentSet());
  const Pass pass{seed, 0, 1, {}};
  const auto state = path->prepare(pass, nowhere, stop, [](double) {});
  const int side =
      std::max(1, int(std::ceil(std::sqrt(double(size.x) * double(size.y) / most_samples))));
  const auto show = [&](int x0, int y0, const Spectrum& radiance) {
    for (int y = y0; y < std::min(y0 + side, size.y); ++y)
      for (int x = x0; x < std::min(x0 + side, size.x); ++x)
        for (int lane = 0; lane < 3; ++lane) image.at(x, y, lane) = radiance[lane];
  };
  parallel_blocks(size_t((size.y + side - 1) / side), 1, [&](size_t row, size_t, size_t) {
    const int y = int(row) * side;
    for (int x = 0; x < size.x && !stop.stop_requested(); x += side) {
      Sampler sampler =
          Sampler::at(seed, 0, Stream::camera, uint64_t(y) * uint64_t(size.x) + uint64_t(x), 0);
      const Vec2f in_square = sampler.next_2d();
      SampleSink sink(ComponentSet::all(), pass.wavelengths);
      path->sample(*state,
                   {std::min(float(x) + in_square.x * float(side), float(size.x)),
                    std::min(float(y) + in_square.y * float(side), float(size.y))},
                   sampler, sink);
      Spectrum sum;
      for (int c = 0; c < component_count; ++c) sum += sink.radiance(Component(c));
      if (sum.is_finite()) show(x, y, sum);
    }
  });
  return image;
}

}  // namespace kaustik
