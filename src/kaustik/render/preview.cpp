#include "kaustik/render/preview.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "kaustik/base/parallel.h"
#include "kaustik/image/denoise.h"
#include "kaustik/image/photometry.h"
#include "kaustik/integrator/make_integrator.h"
#include "kaustik/render/film.h"
#include "kaustik/render/part_picture.h"
#include "kaustik/render/sample_sum.h"

namespace kaustik {
namespace {

/// That it takes at most, about.
constexpr double most_samples = 20000;

/// The picture in squares of pixels, each of which is a pixel of a small picture.
class Squares {
 public:
  explicit Squares(const Vec2i& size)
      : size_(size),
        side_(
            std::max(1, int(std::ceil(std::sqrt(double(size.x) * double(size.y) / most_samples))))),
        count_((size + Vec2i(side_ - 1)) / side_) {}

  const Vec2i& size() const { return size_; }
  /// Of the small picture.
  const Vec2i& count() const { return count_; }
  /// The middle of the square, in the picture's raster.
  Vec2f middle(int x, int y) const {
    return {std::min((float(x) + 0.5f) * float(side_), float(size_.x)),
            std::min((float(y) + 0.5f) * float(side_), float(size_.y))};
  }
  /// The small picture spread out, linearly between the middles of squares.
  Image spread(const Image& small) const {
    Image image(size_.x, size_.y, {"R", "G", "B"});
    parallel_blocks(size_t(size_.y), 16, [&](size_t begin, size_t end, size_t) {
      for (int y = int(begin); y < int(end); ++y)
        for (int x = 0; x < size_.x; ++x) spread_to(x, y, small, image);
    });
    return image;
  }

 private:
  struct Between {
    int first, second;
    float share;  ///< of the second
  };
  Between between(int pixel, int count) const {
    const float at =
        std::clamp((float(pixel) + 0.5f) / float(side_) - 0.5f, 0.0f, float(count - 1));
    const int first = int(at);
    return {first, std::min(first + 1, count - 1), at - float(first)};
  }
  void spread_to(int x, int y, const Image& small, Image& image) const {
    const Between column = between(x, count_.x), row = between(y, count_.y);
    for (int c = 0; c < 3; ++c) {
      const auto in_row = [&](int at) {
        return std::lerp(small.at(column.first, at, c), small.at(column.second, at, c),
                         column.share);
      };
      image.at(x, y, c) = std::lerp(in_row(row.first), in_row(row.second), row.share);
    }
  }

  Vec2i size_;
  int side_;  ///< of a square, pixels
  Vec2i count_;
};

/// All but what lamps emit.
constexpr Component scattered_components[] = {Component::direct, Component::caustic,
                                              Component::indirect, Component::specular,
                                              Component::volume};

float scattered_brightness(const PassPixel& pixel) {
  Spectrum sum;
  for (const Component c : scattered_components) sum += pixel.radiance[size_t(c)];
  return photopic({sum[0], sum[1], sum[2]});
}

/// Makes no pixel brighter than the third brightest of those beside it and itself, but for what
/// lamps emit: single paths that happen upon much light would hide the picture.
void remove_specks(PassTiles& tiles, const Vec2i& size) {
  Image brightness(size.x, size.y, {"Y"});
  const auto pixels = std::make_unique<PassTiles::Pixels>();
  for (size_t tile = 0; tile < tiles.tiles().count(); ++tile) {
    tiles.load(tile, *pixels);
    tiles.tiles().for_pixels_of(tile, [&](int x, int y, size_t place) {
      brightness.at(x, y, 0) = scattered_brightness((*pixels)[place]);
    });
  }
  const auto third_brightest = [&](int x, int y) {
    std::array<float, 9> around{};
    size_t count = 0;
    for (int ny = std::max(0, y - 1); ny <= std::min(size.y - 1, y + 1); ++ny)
      for (int nx = std::max(0, x - 1); nx <= std::min(size.x - 1, x + 1); ++nx)
        around[count++] = brightness.at(nx, ny, 0);
    std::nth_element(around.begin(), around.begin() + 2, around.end(), std::greater<>());
    return around[2];
  };
  for (size_t tile = 0; tile < tiles.tiles().count(); ++tile) {
    tiles.load(tile, *pixels);
    tiles.tiles().for_pixels_of(tile, [&](int x, int y, size_t place) {
      const float own = brightness.at(x, y, 0), most = third_brightest(x, y);
      if (!(own > most)) return;
      for (const Component c : scattered_components)
        (*pixels)[place].radiance[size_t(c)] *= most / own;
    });
    tiles.store(tile, *pixels);
  }
}

/// One path for each square, as a picture with layers.
Image small_picture(const Scene& scene, const Squares& squares, uint64_t seed,
                    const std::stop_token& stop) {
  std::vector<std::string> warnings;
  const auto path =
      make_integrator_alone(Object{"integrator", "path", "", {}, {}, {}}, scene, warnings);
  SplatBuffer nowhere = SplatBuffer::nowhere();
  const Pass pass{seed, 0, 1, {}};
  const auto state = path->prepare(pass, nowhere, stop, [](double) {});
  PassTiles tiles(squares.count());
  parallel_blocks(tiles.tiles().count(), 1, [&](size_t tile, size_t, size_t) {
    const auto pixels = std::make_unique<PassTiles::Pixels>();
    Scratch scratch;
    tiles.tiles().for_pixels_of(tile, [&](int x, int y, size_t place) {
      if (stop.stop_requested()) return;
      const uint64_t square = uint64_t(y) * uint64_t(squares.count().x) + uint64_t(x);
      Sampler sampler = Sampler::at(seed, 0, Stream::preview, square, 0);
      sampler.next_2d();  // for the place in the pixel
      SampleSink sink(path->traits().components, pass.wavelengths, &scratch);
      path->sample(*state, squares.middle(x, y), sampler, sink);
      add_sample(sink, (*pixels)[place]);
    });
    tiles.store(tile, *pixels);
  });
  remove_specks(tiles, squares.count());
  FilmSettings settings = scene.film();
  settings.size = settings.crop_size = squares.count();
  settings.crop_offset = {0, 0};
  Film film(settings, FilmLayers::of(*path));
  film.add_pass(tiles, 0);
  Image image = film.image();
  if (scene.quantity() == Quantity::irradiance)
    image.set_metadata("quantity", std::string("irradiance"));
  return image;
}

}  // namespace

Image preview_picture(const Scene& scene, uint64_t seed, const std::stop_token& stop) {
  const Squares squares(scene.film().crop_size);
  Image small = small_picture(scene, squares, seed, stop);
  // Nobody will look at it then.
  const bool is_smooth = can_denoise(small) && !stop.stop_requested();
  if (is_smooth) small = denoise(small);
  Image image = squares.spread(small);
  if (is_smooth) image.set_metadata("denoised", std::string("true"));
  image.set_metadata(incomplete_key, std::string("a first look: few paths from the camera") +
                                         (is_smooth ? ", smoothed" : ""));
  return image;
}

}  // namespace kaustik
