#include "kaustik/scene/volume_as_vol.h"

#include <bit>
#include <concepts>
#include <cstring>
#include <limits>
#include <variant>

#include "kaustik/base/array.h"
#include "kaustik/base/error.h"

namespace kaustik {
namespace {

/// Little-endian.
template <typename Number>
void append(std::vector<uint8_t>& bytes, Number number) {
  static_assert(sizeof(Number) == 4);
  const auto bits = std::bit_cast<uint32_t>(number);
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(uint8_t(bits >> shift));
}

/// As gridvolume takes whole numbers: shares of the largest one.
template <typename Number>
float sample_of(Number value) {
  if constexpr (std::integral<Number>)
    return float(value) / float(std::numeric_limits<Number>::max());
  else
    return float(value);
}

const Array* buffer_of(const Object& volume) {
  for (const Property& property : volume.properties)
    if (property.name == "data")
      if (const auto* array = std::get_if<std::shared_ptr<const Array>>(&property.value))
        return array->get();
  return nullptr;
}

}  // namespace

std::vector<uint8_t> volume_as_vol(const Object& volume) {
  const Array* buffer = buffer_of(volume);
  if (!buffer || buffer->extents().size() < 3 || buffer->extents().size() > 4)
    throw Error(ErrorKind::input, "'data' has no three dimensions",
                "give samples [z, y, x] or [z, y, x, channel]", volume.place);
  const auto& extents = buffer->extents();
  std::vector<uint8_t> bytes = {'V', 'O', 'L', 3};
  append(bytes, int32_t{1});  // floats
  for (const size_t axis : {2, 1, 0}) append(bytes, int32_t(extents[axis]));
  append(bytes, int32_t(extents.size() == 4 ? extents[3] : 1));
  for (const float corner : {0.f, 0.f, 0.f, 1.f, 1.f, 1.f}) append(bytes, corner);
  buffer->visit([&](auto values) {
    bytes.reserve(bytes.size() + 4 * values.size());
    for (const auto value : values) append(bytes, sample_of(value));
  });
  return bytes;
}

}  // namespace kaustik
