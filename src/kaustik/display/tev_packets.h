#pragma once
// Packets of the picture viewer tev (https://github.com/Tom94/tev, include/tev/Ipc.h): a length of
// four bytes, itself included, a type of one, and its fields. Numbers are little-endian, texts end
// with a zero, channels of pixels are 32-bit floats.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kaustik::tev {

using Packet = std::vector<uint8_t>;

enum class PacketType : uint8_t {
  open_image = 0,
  reload_image = 1,
  close_image = 2,
  update_image = 3,
  create_image = 4,
  update_image_v2 = 5,
  update_image_v3 = 6,
  open_image_v2 = 7
};

/// A rectangle of pixels; (x, y) is its upper left one, counted from the picture's.
struct Rectangle {
  int32_t x = 0, y = 0, width = 0, height = 0;
};

/// Forgets a picture; nothing happens if there is none of that name.
Packet close_image(const std::string& name);

/// A picture, black so far; `grabs_focus`: the viewer shows it at once.
Packet create_image(const std::string& name, bool grabs_focus, int32_t width, int32_t height,
                    const std::vector<std::string>& channels);

/// New pixels of a rectangle, `values` pixel by pixel with all `channels` of each (UpdateImageV3).
/// Throws std::logic_error if their number is another.
Packet update_image(const std::string& name, const std::vector<std::string>& channels,
                    const Rectangle& rectangle, std::span<const float> values);

}  // namespace kaustik::tev
