#include "picture_info.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "file_names.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/layer_names.h"
#include "option_values.h"

namespace kaustik::app {
namespace {

/// Of channels of a layer, what stands behind its name: "R", "G", "B". Files sort them by name.
std::vector<std::string> channels_of(const std::string& layer,
                                     const std::vector<std::string>& channels) {
  std::vector<std::string> letters;
  for (const std::string& name : channels)
    if (layer_names({name})[0] == layer)
      letters.push_back(layer.empty() ? name : name.substr(layer.size() + 1));
  const auto place = [](const std::string& letter) { return std::string("RGB").find(letter); };
  std::stable_sort(letters.begin(), letters.end(),
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return letters;
}

}  // namespace

bool is_picture_name(const std::string& path) {
  const std::vector<std::string>& pictures = picture_extensions();
  return std::find(pictures.begin(), pictures.end(), extension_of(path)) != pictures.end();
}

void print_picture(const std::string& path) {
  const Image image = read_image(path);
  fmt::print("picture    {} × {} pixels\n", image.width(), image.height());
  const PictureFrame& frame = image.frame();
  if (!image.is_whole())
    fmt::print("window     of {} × {} pixels, from {}, {} on\n", frame.width, frame.height, frame.x,
               frame.y);
  for (const std::string& layer : layer_names(image.channel_names()))
    fmt::print("layer      {}{}\n", layer.empty() ? "" : layer + ": ",
               fmt::join(channels_of(layer, image.channel_names()), ", "));
  for (const auto& entry : image.metadata())
    std::visit([&](const auto& shown) { fmt::print("metadata   {}: {}\n", entry.first, shown); },
               entry.second);
}

}  // namespace kaustik::app
