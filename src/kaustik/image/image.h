#pragma once
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "kaustik/base/vec.h"
#include "kaustik/image/zeroed_allocator.h"

namespace kaustik {

using MetadataValue = std::variant<std::string, double, int64_t>;

/// The picture that an image is a window of: its size, and where in it the image's upper left pixel
/// lies. EXR calls the picture display window and the image data window. A window may reach beyond
/// its picture.
struct PictureFrame {
  int width = 0, height = 0;
  int x = 0, y = 0;
  friend bool operator==(const PictureFrame&, const PictureFrame&) = default;
};

/// Metadata of an image that was rendered as a window: beyond it nothing is known. Without it what
/// an image lacks of its picture is black.
inline constexpr const char* crop_window_key = "crop_window";

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

  /// Of a new image: just its own size.
  const PictureFrame& frame() const { return frame_; }
  /// Throws Error(input) if the picture has no size.
  void set_frame(const PictureFrame& frame);
  /// The image is all of its picture and nothing else.
  bool is_whole() const { return frame_ == PictureFrame{width_, height_}; }

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

  /// Files keep the channel at 32 bits, because the file that it comes from does; of a new channel:
  /// not.
  bool keeps_floats(int channel) const { return keeps_floats_[size_t(channel)]; }
  void set_keeps_floats(int channel) { keeps_floats_[size_t(channel)] = true; }

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
  std::vector<bool> keeps_floats_;
  PictureFrame frame_;
  /// Memory that is never written costs nothing: a header that lies is found out before.
  std::vector<float, ZeroedAllocator<float>> values_;
  std::vector<std::pair<std::string, MetadataValue>> metadata_;
  std::map<std::string, size_t, std::less<>> metadata_index_;
};

/// The rectangle of the image's picture with the upper left corner (x, y): black where the image
/// has no pixels. Metadata and picture stay.
Image window_of(const Image& image, int x, int y, int width, int height);
/// Whether any of the image's pixels lies in its picture.
bool has_visible_part(const Image& image);
/// What the image has of its picture: without pixels that lie outside. Throws Error(input) if all
/// of them do.
Image visible_part(Image image);

/// Most pixels that an image may have.
inline constexpr int64_t max_image_pixels = 500'000'000;

/// What pictures that are read may take of this machine's memory where nothing else is said: half.
int64_t default_picture_memory();

/// All of the image's picture and nothing else, see window_of(). Throws Error(input) if it is too
/// large for an image, Error(system) if it takes more than `memory_bytes`.
Image whole_picture(Image image, int64_t memory_bytes = default_picture_memory());

/// Throws Error(input) if a size is not positive, has over max_image_pixels, or needs more memory
/// than the machine has.
void check_image_size(int64_t width, int64_t height, int64_t channels);

/// Red, green and blue of a picture or of one of its layers.
struct RgbView {
  std::array<std::span<const float>, 3> planes;
  std::shared_ptr<const std::vector<float>> zeros;  ///< stands for channels that are not there
  Vec3f operator[](size_t pixel) const {
    return {planes[0][pixel], planes[1][pixel], planes[2][pixel]};
  }
};

/// Which of the channels are red, green and blue of `layer`, "" for the picture itself; -1: none of
/// them, it is black. They are called "R", "G", "B" (else "r", "g", "b", else "X", "Y", "Z", else
/// "Y", "Z" or "V" thrice), two of "R", "G", "B", the one channel that is called like the layer, or
/// the only one but for opacity. A picture without channels of its own is the only layer with
/// colours, or the one that is called beauty, combined, rgba, rgb or color. None: nothing of that.
std::optional<std::array<int, 3>> colour_channels(const std::vector<std::string>& names,
                                                  const std::string& layer = {});

/// Those of a picture that a scene names, of which `wanted` chooses: "" the picture itself (where
/// it has no channels of its own, the first layer with colours by its name), else a layer, a
/// channel, or one of the letters r, g, b, a, x, y, z, whatever their case; r, g and b of a grey
/// picture are its grey. None: there is nothing of that.
std::optional<std::array<int, 3>> picture_channels(const std::vector<std::string>& names,
                                                   const std::string& wanted);

/// The colour_channels() of an image. Throws Error(input) if it has none. Valid as long as the
/// image is and keeps its channels.
RgbView rgb_view(const Image& image, const std::string& layer = {});

}  // namespace kaustik
