#include "kaustik/image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <set>

#include "kaustik/base/error.h"
#include "kaustik/base/memory.h"

namespace kaustik {
namespace {

void check_channel_names(const std::vector<std::string>& names) {
  std::set<std::string_view> seen;
  for (const std::string& name : names) {
    if (name.empty())
      throw Error(ErrorKind::input, "an image channel has no name", "name every channel");
    if (!seen.insert(name).second)
      throw Error(ErrorKind::input, fmt::format("image channel '{}' occurs twice", name),
                  "give every channel a name of its own");
  }
}

/// In pixels of the picture, the last ones excluded.
struct Corners {
  int left, upper, right, lower;
};

/// Of what the image has of its picture; there may be nothing between them.
Corners visible_corners(const Image& image) {
  const PictureFrame& frame = image.frame();
  return {std::max(frame.x, 0), std::max(frame.y, 0),
          int(std::min(int64_t(frame.x) + image.width(), int64_t(frame.width))),
          int(std::min(int64_t(frame.y) + image.height(), int64_t(frame.height)))};
}

}  // namespace

int64_t default_picture_memory() { return physical_memory_bytes() / 2; }

void check_image_size(int64_t width, int64_t height, int64_t channels) {
  const std::string what = fmt::format("an image of {} x {} pixels", width, height);
  if (width <= 0 || height <= 0)
    throw Error(ErrorKind::input, what, "width and height must be at least 1");
  // By division, since the product may overflow.
  if (width > max_image_pixels / height)
    throw Error(ErrorKind::input, what + " is too large",
                fmt::format("at most {} pixels are possible", max_image_pixels));
  const int64_t bytes_per_channel = width * height * int64_t(sizeof(float));
  if (channels < 0 || channels > physical_memory_bytes() / bytes_per_channel)
    throw Error(
        ErrorKind::input,
        fmt::format("{} with {} channels does not fit into this machine's memory", what, channels),
        "choose a smaller size or fewer channels");
}

Image::Image(int width, int height, std::vector<std::string> channel_names) {
  check_image_size(width, height, int64_t(channel_names.size()));
  check_channel_names(channel_names);
  width_ = width;
  height_ = height;
  frame_ = {width, height};
  channel_names_ = std::move(channel_names);
  keeps_floats_.resize(channel_names_.size());
  try {
    values_.resize(pixel_count() * channel_names_.size());
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::system,
                fmt::format("no memory for an image of {} x {} pixels with {} channels", width,
                            height, channel_names_.size()),
                "choose a smaller size or fewer channels");
  }
}

int Image::find_channel(std::string_view name) const {
  const auto found = std::find(channel_names_.begin(), channel_names_.end(), name);
  return found == channel_names_.end() ? -1 : int(found - channel_names_.begin());
}

int Image::add_channel(const std::string& name) {
  std::vector<std::string> names = channel_names_;
  names.push_back(name);
  check_image_size(width_, height_, int64_t(names.size()));
  check_channel_names(names);
  values_.resize(pixel_count() * names.size());
  keeps_floats_.resize(names.size());
  channel_names_ = std::move(names);
  return channel_count() - 1;
}

void Image::set_frame(const PictureFrame& frame) {
  // It takes no memory: crop windows may be of pictures too large for one image.
  if (frame.width <= 0 || frame.height <= 0)
    throw Error(ErrorKind::input,
                fmt::format("a picture of {} x {} pixels", frame.width, frame.height),
                "width and height must be at least 1");
  frame_ = frame;
}

void Image::set_metadata(const std::string& key, MetadataValue value) {
  const auto [entry, is_new] = metadata_index_.try_emplace(key, metadata_.size());
  if (is_new)
    metadata_.emplace_back(key, std::move(value));
  else
    metadata_[entry->second].second = std::move(value);
}

const MetadataValue* Image::find_metadata(std::string_view key) const {
  const auto found = metadata_index_.find(key);
  return found == metadata_index_.end() ? nullptr : &metadata_[found->second].second;
}

Image window_of(const Image& image, int x, int y, int width, int height) {
  Image window(width, height, image.channel_names());
  const PictureFrame& frame = image.frame();
  window.set_frame({frame.width, frame.height, x, y});
  window.set_srgb_encoded(image.is_srgb_encoded());
  for (int c = 0; c < image.channel_count(); ++c)
    if (image.keeps_floats(c)) window.set_keeps_floats(c);
  for (const auto& [key, value] : image.metadata()) window.set_metadata(key, value);
  const int64_t left = std::max(x, frame.x), upper = std::max(y, frame.y);
  const int64_t right = std::min(int64_t(x) + width, int64_t(frame.x) + image.width());
  const int64_t lower = std::min(int64_t(y) + height, int64_t(frame.y) + image.height());
  if (left >= right) return window;
  for (int c = 0; c < image.channel_count(); ++c)
    for (int64_t row = upper; row < lower; ++row)
      std::copy_n(&image.channel(c)[size_t((row - frame.y) * image.width() + left - frame.x)],
                  right - left, &window.channel(c)[size_t((row - y) * width + left - x)]);
  return window;
}

Image whole_picture(Image image, int64_t memory_bytes) {
  if (image.is_whole()) return image;
  const PictureFrame& frame = image.frame();
  check_image_size(frame.width, frame.height, 0);
  const double bytes = double(frame.width) * frame.height * image.channel_count() * sizeof(float);
  if (bytes > double(memory_bytes))
    throw Error(ErrorKind::system,
                fmt::format("all {} x {} pixels of the picture that the image is a window of take "
                            "{:.3g} MB of memory, and they may take {:.3g} MB",
                            frame.width, frame.height, bytes / 1e6, double(memory_bytes) / 1e6),
                "take the window alone, or use a machine with more memory");
  return window_of(image, 0, 0, frame.width, frame.height);
}

bool has_visible_part(const Image& image) {
  const Corners part = visible_corners(image);
  return part.left < part.right && part.upper < part.lower;
}

Image visible_part(Image image) {
  const PictureFrame& frame = image.frame();
  if (!has_visible_part(image))
    throw Error(
        ErrorKind::input,
        fmt::format("none of the {} x {} pixels at ({}, {}) lies in the picture of {} x {}",
                    image.width(), image.height(), frame.x, frame.y, frame.width, frame.height),
        "give an image whose data window meets its display window");
  const Corners part = visible_corners(image);
  const int width = part.right - part.left, height = part.lower - part.upper;
  if (width == image.width() && height == image.height()) return image;
  return window_of(image, part.left, part.upper, width, height);
}

}  // namespace kaustik
