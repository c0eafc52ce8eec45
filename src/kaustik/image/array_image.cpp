#include "kaustik/image/array_image.h"

#include <fmt/format.h>

#include "kaustik/base/error.h"
#include "kaustik/image/formats.h"

namespace kaustik {
namespace {

/// Copies every `step`-th value; integers over `maximum`, as decoders do it.
template <typename T>
void copy_channel(const T* from, size_t step, float maximum, std::span<float> to) {
  for (float& value : to) {
    value = std::is_integral_v<T> ? float(*from) / maximum : float(*from);
    from += step;
  }
}

/// The buffer itself is the program's.
void check_memory(const Array& array, size_t channels, const ReadOptions& options) {
  const double per_pixel = double(channels) * sizeof(float) + double(options.kept_bytes_per_pixel);
  const double bytes = double(array.count() / channels) * per_pixel;
  if (bytes <= double(options.memory_bytes)) return;
  throw Error(
      ErrorKind::system,
      fmt::format("a picture of {} takes {:.3g} MB of memory, and it may take {:.3g} MB",
                  extents_text(array.extents()), bytes / 1e6, double(options.memory_bytes) / 1e6),
      options.memory_remedy);
}

}  // namespace

Image image_of_array(const Array& array, const ReadOptions& options) {
  const std::vector<size_t>& extents = array.extents();
  if (extents.size() == 1 && array.type() == ElementType::uint8)
    return read_image({reinterpret_cast<const uint8_t*>(array.bytes().data()), array.count()},
                      "data", options);
  const size_t channels = extents.size() == 3 ? extents[2] : 1;
  if ((extents.size() != 2 && extents.size() != 3) ||
      (channels != 1 && channels != 3 && channels != 4))
    throw Error(ErrorKind::input,
                fmt::format("a picture cannot have the extents {}", extents_text(extents)),
                "give [rows, columns], or [rows, columns, 1, 3 or 4], or a file's bytes as uint8");
  constexpr size_t most = size_t(max_image_pixels);
  check_image_size(int64_t(std::min(extents[1], most)), int64_t(std::min(extents[0], most)),
                   int64_t(channels));
  check_memory(array, channels, options);
  const auto height = int(extents[0]), width = int(extents[1]);
  Image image(width, height, formats::channel_names_for(int(channels)));
  array.visit([&]<typename T>(std::span<const T> values) {
    if constexpr (std::is_same_v<T, uint8_t> || std::is_same_v<T, uint16_t> ||
                  std::is_floating_point_v<T>) {
      const float maximum = sizeof(T) == 1 ? 255.0f : 65535.0f;
      for (size_t c = 0; c < channels; ++c)
        copy_channel(values.data() + c, channels, maximum, image.channel(int(c)));
    } else {
      throw Error(ErrorKind::input,
                  fmt::format("a picture cannot be made of {}", element_name(array.type())),
                  "give uint8, uint16, float32 or float64");
    }
  });
  image.set_srgb_encoded(is_integer(array.type()));
  if (options.srgb_to_linear && image.is_srgb_encoded()) formats::linearise(image);
  return image;
}

}  // namespace kaustik
