#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>
#include <unordered_map>

#include "kaustik/base/error.h"
#include "kaustik/image/image.h"

namespace kaustik {
namespace {

using Channels = std::array<int, 3>;

class ChannelFinder {
 public:
  explicit ChannelFinder(const std::vector<std::string>& names) : names_(names) {
    for (size_t i = 0; i < names.size(); ++i) index_.emplace(names[i], int(i));
  }

  std::optional<Channels> picture() const {
    if (const auto found = of_layer("")) return found;
    const std::optional<int> alone = only_one();
    if (alone) return Channels{*alone, *alone, *alone};
    return of_main_layer();
  }

  std::optional<Channels> of_layer(const std::string& prefix) const {
    for (const char* names : {"RGB", "rgb", "XYZ", "YYY", "ZZZ", "VVV"})
      if (const Channels found = find(prefix, names); count(found) == 3) return found;
    if (const Channels found = find(prefix, "RGB"); count(found) == 2) return found;
    return std::nullopt;
  }

  std::optional<Channels> named(const std::string& name) const {
    const int index = index_of(name);
    if (index < 0) return std::nullopt;
    return Channels{index, index, index};
  }
  /// By one letter, whatever its case.
  std::optional<Channels> lettered(char letter) const {
    const auto code = static_cast<unsigned char>(letter);
    for (const int c : {std::toupper(code), std::tolower(code)})
      if (const auto found = named(std::string(1, char(c)))) return found;
    const auto all = picture();
    const bool is_grey = all && (*all)[0] == (*all)[1] && (*all)[0] == (*all)[2];
    return is_grey && std::string_view("rgbRGB").find(letter) != std::string_view::npos
               ? all
               : std::nullopt;
  }
  /// By its name.
  std::optional<Channels> first_layer() const {
    const std::set<std::string> layers = colour_layers();
    if (layers.empty()) return std::nullopt;
    return of_layer(*layers.begin());
  }

 private:
  int index_of(const std::string& name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? -1 : found->second;
  }
  Channels find(const std::string& prefix, const char* names) const {
    return {index_of(prefix + names[0]), index_of(prefix + names[1]), index_of(prefix + names[2])};
  }
  static int count(const Channels& channels) {
    return int(std::count_if(channels.begin(), channels.end(), [](int c) { return c >= 0; }));
  }
  /// The only channel that is no opacity.
  std::optional<int> only_one() const {
    std::optional<int> result;
    for (size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] == "A") continue;
      if (result) return std::nullopt;
      result = int(i);
    }
    return result;
  }
  /// What the names of layers with three colours begin with.
  std::set<std::string> colour_layers() const {
    std::set<std::string> layers;
    for (const std::string& name : names_)
      if (name.ends_with(".R") && count(find(name.substr(0, name.size() - 1), "RGB")) == 3)
        layers.insert(name.substr(0, name.size() - 1));
    return layers;
  }
  /// Of all layers with three colours the only one, or the one whose name says so.
  std::optional<Channels> of_main_layer() const {
    const std::set<std::string> layers = colour_layers();
    if (layers.size() == 1) return of_layer(*layers.begin());
    for (const char* usual : {"beauty", "combined", "rgba", "rgb", "color"}) {
      std::vector<std::string> called;
      std::copy_if(layers.begin(), layers.end(), std::back_inserter(called),
                   [&](const std::string& layer) { return last_name(layer) == usual; });
      if (called.size() == 1) return of_layer(called[0]);
    }
    return std::nullopt;
  }
  /// "combined" of "ViewLayer.Combined.".
  static std::string last_name(const std::string& prefix) {
    std::string name = prefix.substr(0, prefix.size() - 1);
    name = name.substr(name.rfind('.') + 1);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return name;
  }

  const std::vector<std::string>& names_;
  std::unordered_map<std::string, int> index_;
};

/// As many names as help; files may have thousands.
std::string some_of(const std::vector<std::string>& names) {
  constexpr size_t most = 40;
  if (names.size() <= most) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{}, … ({} in all)", fmt::join(names.begin(), names.begin() + most, ", "),
                     names.size());
}

}  // namespace

std::optional<std::array<int, 3>> colour_channels(const std::vector<std::string>& names,
                                                  const std::string& layer) {
  const ChannelFinder finder(names);
  if (layer.empty()) return finder.picture();
  const auto found = finder.of_layer(layer + ".");
  return found ? found : finder.named(layer);
}

std::optional<std::array<int, 3>> picture_channels(const std::vector<std::string>& names,
                                                   const std::string& wanted) {
  if (const auto found = colour_channels(names, wanted)) return found;
  const ChannelFinder finder(names);
  if (wanted.empty()) return finder.first_layer();
  return wanted.size() == 1 ? finder.lettered(wanted[0]) : std::nullopt;
}

RgbView rgb_view(const Image& image, const std::string& layer) {
  const auto channels = colour_channels(image.channel_names(), layer);
  if (!channels)
    throw Error(ErrorKind::input,
                layer.empty() ? std::string("the image has no colour channels")
                              : fmt::format("the image has no layer '{}'", layer),
                "name a layer; the channels are: " + some_of(image.channel_names()));
  RgbView view;
  for (size_t i = 0; i < 3; ++i) {
    const int index = (*channels)[i];
    if (index < 0 && !view.zeros)
      view.zeros = std::make_shared<const std::vector<float>>(image.pixel_count());
    view.planes[i] = index < 0 ? std::span<const float>(*view.zeros) : image.channel(index);
  }
  return view;
}

}  // namespace kaustik
