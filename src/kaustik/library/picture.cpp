#include "kaustik/picture.h"

#include <algorithm>
#include <cstring>

#include "kaustik/base/parallel.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/layer_names.h"
#include "kaustik/image/tone_mapping.h"
#include "kaustik/library/access.h"
#include "kaustik/library/boundary.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/render/part_picture.h"

namespace kaustik::v0 {
namespace details {

struct PictureState {
  Image image;
  std::shared_ptr<const Film> film;  ///< null: without errors
  uint32_t passes = 0;
  int threads = 0;
  mutable std::once_flag once = {};
  mutable std::optional<FilmErrors> errors = {};
};

Picture Access::picture(Image image, std::shared_ptr<const Film> film, uint32_t passes,
                        int threads) {
  auto state = std::make_shared<PictureState>();
  state->image = std::move(image);
  state->film = std::move(film);
  state->passes = passes;
  state->threads = threads;
  return v0::Picture(std::move(state));
}

}  // namespace details

namespace {

using details::PictureState;

/// Calls `use` with the errors, by no more threads than the session had.
template <typename Use>
auto with_errors(const PictureState& state, const Use& use) {
  return guarded([&] {
    if (!state.film)
      throw misuse("the picture knows no errors",
                   "take it after the end, or ask for a snapshot with errors");
    decltype(use(*state.errors)) result;
    with_threads(state.threads, [&] {
      std::call_once(state.once, [&] { isolated([&] { state.errors.emplace(*state.film); }); });
      result = use(*state.errors);
    });
    return result;
  });
}

Estimate shown(const KnownLuminance& known) {
  return {known.mean, known.deviation, known.bias, known.freedom, known.bias_deviation};
}

void check_layer(const Image& image, const std::string& layer) {
  if (!colour_channels(image.channel_names(), layer))
    throw wrong_input("the picture has no layer '" + layer + "'",
                      "ask for one of layers(); sessions keep them if the film does");
}

}  // namespace

Picture::Picture(std::shared_ptr<const PictureState> state) : state_(std::move(state)) {}

int Picture::width() const noexcept { return state_->image.width(); }
int Picture::height() const noexcept { return state_->image.height(); }
uint32_t Picture::passes() const noexcept { return state_->passes; }
bool Picture::is_incomplete() const noexcept {
  return state_->image.find_metadata(incomplete_key) != nullptr;
}

std::vector<std::string> Picture::channels() const { return state_->image.channel_names(); }

std::vector<std::string> Picture::layers() const {
  return layer_names(state_->image.channel_names());
}

bool Picture::has_channel(const std::string& name) const noexcept {
  return state_->image.find_channel(name) >= 0;
}

std::span<const float> Picture::plane(const std::string& channel) const {
  const int index = state_->image.find_channel(channel);
  if (index < 0)
    throw wrong_input("the picture has no channel '" + channel + "'",
                      "ask for one of channels(); sessions keep layers if the film does");
  return state_->image.channel(index);
}

void Picture::copy_rgb(float* target, ptrdiff_t pixel_stride_bytes, ptrdiff_t row_stride_bytes,
                       const std::string& layer) const {
  guarded([&] {
    if (target == nullptr) throw wrong_input("the target is a null pointer", "give it memory");
    const Image& image = state_->image;
    check_layer(image, layer);
    const RgbView rgb = rgb_view(image, layer);
    const ptrdiff_t step = pixel_stride_bytes != 0 ? pixel_stride_bytes : 3 * sizeof(float);
    const ptrdiff_t row_step = row_stride_bytes != 0 ? row_stride_bytes : step * image.width();
    for (int y = 0; y < image.height(); ++y) {
      char* pixel = reinterpret_cast<char*>(target) + row_step * y;
      for (int x = 0; x < image.width(); ++x, pixel += step) {
        const Vec3f value = rgb[size_t(y) * size_t(image.width()) + size_t(x)];
        const float values[3] = {value.x, value.y, value.z};
        std::memcpy(pixel, values, sizeof(values));
      }
    }
  });
}

ShownPicture Picture::tonemap(const ToneSettings& tone, const std::string& layer) const {
  return guarded([&] {
    check_layer(state_->image, layer);
    const auto op = make_tone_operator(tone.name, tone.parameters);
    ShownPicture result;
    with_threads(state_->threads, [&] {
      const Image shown_image = tone_map(state_->image, *op, layer);
      result = {shown_image.width(), shown_image.height(), srgb_bytes(shown_image)};
    });
    return result;
  });
}

void Picture::write(const std::string& path, const WriteSettings& settings) const {
  guarded([&] {
    check_writable(path);
    if (settings.jpeg_quality < 1 || settings.jpeg_quality > 100)
      throw wrong_input("the quality of a JPEG is not from 1 to 100", "95 is usual");
    WriteOptions options;
    options.exr_half = !settings.full_float;
    options.tone = make_tone_operator(settings.tone.name, settings.tone.parameters);
    options.layer = settings.layer;
    options.jpeg_quality = settings.jpeg_quality;
    with_threads(state_->threads, [&] { write_image(state_->image, path, options); });
  });
}

bool Picture::has_errors() const noexcept { return state_->film != nullptr; }

Estimate Picture::pixel(int x, int y) const {
  return with_errors(*state_, [&](const FilmErrors& errors) {
    if (x < 0 || y < 0 || x >= width() || y >= height())
      throw wrong_input("a pixel lies beyond the picture",
                        "count x and y from 0, from the top left");
    return shown(errors.known(size_t(y) * size_t(width()) + size_t(x)));
  });
}

Estimate Picture::region(const Region& r) const {
  return with_errors(*state_, [&](const FilmErrors& errors) {
    if (r.width < 1 || r.height < 1 || r.x < 0 || r.y < 0 || r.x > width() - r.width ||
        r.y > height() - r.height)
      throw wrong_input("a region is empty, or reaches beyond the picture",
                        "count x and y from 0, from the top left");
    return shown(errors.known(PixelRegion{r.x, r.y, r.width, r.height}));
  });
}

double Picture::relative_error() const {
  return with_errors(*state_, [](const FilmErrors& errors) { return errors.of_picture(); });
}

Interval Estimate::interval(double confidence) const {
  return guarded([&] {
    if (!(confidence > 0 && confidence < 1))
      throw wrong_input("the chance of an interval is not between 0 and 1", "0.95 is usual");
    const KnownLuminance known{value, standard_error, bias, degrees_of_freedom,
                               bias_standard_error};
    const double half = known.interval(confidence).half_width;
    return Interval{value - half, value + half};
  });
}

}  // namespace kaustik::v0
