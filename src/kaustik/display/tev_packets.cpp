#include "kaustik/display/tev_packets.h"

#include <bit>
#include <stdexcept>

namespace kaustik::tev {
namespace {

class PacketWriter {
 public:
  explicit PacketWriter(PacketType type) {
    put_number(uint32_t(0), 4);  // the length, known at the end
    put_number(uint64_t(type), 1);
  }
  void put_flag(bool flag) { put_number(flag ? 1 : 0, 1); }
  void put_int(int32_t value) { put_number(uint32_t(value), 4); }
  void put_long(int64_t value) { put_number(uint64_t(value), 8); }
  void put_float(float value) { put_number(std::bit_cast<uint32_t>(value), 4); }
  void put_text(const std::string& text) {
    for (const char c : text)
      if (c != '\0') bytes_.push_back(uint8_t(c));
    bytes_.push_back(0);
  }
  void put_texts(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) put_text(text);
  }
  void reserve(size_t size) { bytes_.reserve(bytes_.size() + size); }
  Packet finish() {
    for (size_t i = 0; i < 4; ++i) bytes_[i] = uint8_t(bytes_.size() >> (8 * i));
    return std::move(bytes_);
  }

 private:
  void put_number(uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_.push_back(uint8_t(value >> (8 * i)));
  }
  Packet bytes_;
};

}  // namespace

Packet close_image(const std::string& name) {
  PacketWriter packet(PacketType::close_image);
  packet.put_text(name);
  return packet.finish();
}

Packet create_image(const std::string& name, bool grabs_focus, int32_t width, int32_t height,
                    const std::vector<std::string>& channels) {
  PacketWriter packet(PacketType::create_image);
  packet.put_flag(grabs_focus);
  packet.put_text(name);
  packet.put_int(width);
  packet.put_int(height);
  packet.put_int(int32_t(channels.size()));
  packet.put_texts(channels);
  return packet.finish();
}

Packet update_image(const std::string& name, const std::vector<std::string>& channels,
                    const Rectangle& rectangle, std::span<const float> values) {
  if (values.size() != channels.size() * size_t(rectangle.width) * size_t(rectangle.height))
    throw std::logic_error("tev::update_image: the rectangle has another number of values");
  PacketWriter packet(PacketType::update_image_v3);
  packet.reserve(4 * values.size() + 256);
  packet.put_flag(false);
  packet.put_text(name);
  packet.put_int(int32_t(channels.size()));
  packet.put_texts(channels);
  packet.put_int(rectangle.x);
  packet.put_int(rectangle.y);
  packet.put_int(rectangle.width);
  packet.put_int(rectangle.height);
  // Where each channel begins, and how far its values are apart.
  for (size_t i = 0; i < channels.size(); ++i) packet.put_long(int64_t(i));
  for (size_t i = 0; i < channels.size(); ++i) packet.put_long(int64_t(channels.size()));
  for (const float value : values) packet.put_float(value);
  return packet.finish();
}

}  // namespace kaustik::tev
