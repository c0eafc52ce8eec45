#pragma once
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

using MetadataValue = std::variant<std::string, double, int64_t>;

/// A buffer of float pixels with named channels, stored channel by channel, each row by row from
/// the top left. Names follow OpenEXR: "R", "G", "B" are the picture itself, "direct.R",
/// "albedo.R", "N.X", "depth.Z" belong to layers, "Y" alone is a grey picture, "A" is opacity.
/// Colours are linear Rec. 709, radiance in W/(sr·m²), unless the image says otherwise.
class Image {
 public:
  /// No pixels, no channels.
  Image() = default;
  /// All zero. Throws Error(input) if check_image_size() does, or a name is empty or twice there.
  Image(int width, int height, std::vector<std::string> channel_names);

  int width() const { return width_; }
  int height() const { return height_; }
  size_t pixel_count() const { return size_t(width_) * size_t(height_); }
  bool empty() const { return values_.empty(); }

  int channel_count() const { return int(channel_names_.size()); }
  const std::vector<std::string>& channel_names() const { return channel_names_; }
  /// Index of a channel, -1 if there is none of that name.
  int find_channel(std::string_view name) const;
  /// Appends a channel of zeros and returns its index; throws as the constructor does.
  int add_channel(const std::string& name);

  float& at(int x, int y, int channel) { return values_[index_of(x, y, channel)]; }
  float at(int x, int y, int channel) const { return values_[index_of(x, y, channel)]; }
  /// All pixels of one channel; pixel (x, y) is number y · width + x.
  std::span<float> channel(int index) {
    return {values_.data() + size_t(index) * pixel_count(), pixel_count()};
  }
  std::span<const float> channel(int index) const {
    return {values_.data() + size_t(index) * pixel_count(), pixel_count()};
  }

  /// In the order in which it was set (files may keep another one).
  const std::vector<std::pair<std::string, MetadataValue>>& metadata() const { return metadata_; }
  /// Replaces the value of `key` or appends it.
  void set_metadata(const std::string& key, MetadataValue value);
  /// Null if there is no such key.
  const MetadataValue* find_metadata(std::string_view key) const;

  /// Values of colour channels are still sRGB encoded (see ReadOptions).
  bool is_srgb_encoded() const { return is_srgb_encoded_; }
  void set_srgb_encoded(bool encoded) { is_srgb_encoded_ = encoded; }

 private:
  size_t index_of(int x, int y, int channel) const {
    assert(x >= 0 && x < width_ && y >= 0 && y < height_);
    assert(channel >= 0 && channel < channel_count());
    return (size_t(channel) * size_t(height_) + size_t(y)) * size_t(width_) + size_t(x);
  }

  int width_ = 0;
  int height_ = 0;
  bool is_srgb_encoded_ = false;
  std::vector<std::string> channel_names_;
  std::vector<float> values_;
  std::vector<std::pair<std::string, MetadataValue>> metadata_;
};

/// Most pixels that an image may have.
inline constexpr int64_t max_image_pixels = 500'000'000;

/// Throws Error(input) if a size is not positive, has over max_image_pixels, or needs more memory
/// than the machine has.
void check_image_size(int64_t width, int64_t height, int64_t channels);

/// Red, green and blue of a picture or of one of its layers.
struct RgbView {
  std::array<std::span<const float>, 3> planes;
  Vec3f operator[](size_t pixel) const {
    return {planes[0][pixel], planes[1][pixel], planes[2][pixel]};
  }
};

/// The channels "R", "G", "B" (else "r", "g", "b", else "X", "Y", "Z", else "Y", "Z" or "V" thrice)
/// of `layer`, "" for the picture itself; else the one channel that is called like the layer, or
/// the image's only one (but for opacity), thrice. Throws Error(input) if the image has none. Valid
/// as long as the image is and keeps its channels.
RgbView rgb_view(const Image& image, const std::string& layer = {});

}  // namespace kaustik
