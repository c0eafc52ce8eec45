#include "kaustik/image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <optional>
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

}  // namespace

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
  channel_names_ = std::move(channel_names);
  try {
    values_.assign(pixel_count() * channel_names_.size(), 0.0f);
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
  values_.resize(pixel_count() * names.size(), 0.0f);
  channel_names_ = std::move(names);
  return channel_count() - 1;
}

void Image::set_metadata(const std::string& key, MetadataValue value) {
  const auto found = std::find_if(metadata_.begin(), metadata_.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  if (found == metadata_.end())
    metadata_.emplace_back(key, std::move(value));
  else
    found->second = std::move(value);
}

const MetadataValue* Image::find_metadata(std::string_view key) const {
  for (const auto& [name, value] : metadata_)
    if (name == key) return &value;
  return nullptr;
}

RgbView rgb_view(const Image& image, const std::string& layer) {
  const auto view_of = [&](const std::array<std::string, 3>& names) -> std::optional<RgbView> {
    RgbView view;
    for (size_t i = 0; i < 3; ++i) {
      const int index = image.find_channel(names[i]);
      if (index < 0) return std::nullopt;
      view.planes[i] = image.channel(index);
    }
    return view;
  };
  const std::string prefix = layer.empty() ? "" : layer + ".";
  for (const char* names : {"RGB", "rgb", "XYZ", "YYY", "ZZZ", "VVV"})
    if (const auto view = view_of({prefix + names[0], prefix + names[1], prefix + names[2]}))
      return *view;
  std::string alone = layer;
  if (layer.empty() && image.channel_count() == 1 && image.find_channel("A") < 0)
    alone = image.channel_names()[0];
  if (const auto view = view_of({alone, alone, alone})) return *view;
  throw Error(
      ErrorKind::input,
      layer.empty() ? std::string("the image has no colour channels")
                    : fmt::format("the image has no layer '{}'", layer),
      fmt::format("name a layer; the channels are: {}", fmt::join(image.channel_names(), ", ")));
}

}  // namespace kaustik
