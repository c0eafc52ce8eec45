#include "kaustik/image/picture_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kaustik/base/srgb.h"
#include "kaustik/image/array_image.h"

namespace kaustik {
namespace {

/// Errors of reading get the place of the file name or of the buffer.
Image read_at(const Arguments& arguments, const ReadOptions& options) {
  const Array* buffer = arguments.array("data").get();
  try {
    return buffer ? image_of_array(*buffer, options)
                  : read_image(arguments.text("filename"), options);
  } catch (const Error& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems)
      if (!problem.place.file) problem.place = picture_place(arguments);
    throw Error(error.kind(), std::move(problems));
  }
}

/// Alpha is no colour, and which of other channels is meant nobody knows.
[[noreturn]] void fail_without(const Image& image, const Arguments& arguments,
                               const std::string& wanted) {
  std::string names;
  // The message of rgb_view() names the channels.
  try {
    rgb_view(image, wanted);
  } catch (const Error& error) {
    names = error.problems().front().remedy;
  }
  if (wanted.empty())
    throw Error(ErrorKind::input,
                fmt::format("{} has no colours: {}", picture_name(arguments), names),
                "save it with the channels R, G and B, or with one that is called Y",
                picture_place(arguments));
  throw Error(ErrorKind::input,
              fmt::format("{} has no channel or layer '{}'", picture_name(arguments), wanted),
              names, arguments.place_of("channel"));
}

/// These channels of the image alone, under the names of a picture.
Image under_usual_names(const Image& image, const std::array<int, 3>& channels) {
  const bool is_grey = channels[0] == channels[1] && channels[0] == channels[2];
  Image result(image.width(), image.height(),
               is_grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"});
  for (int c = 0; c < result.channel_count(); ++c)
    if (const int from = channels[size_t(c)]; from >= 0)
      std::ranges::copy(image.channel(from), result.channel(c).begin());
  return result;
}

std::set<int> distinct(const std::array<int, 3>& channels) {
  std::set<int> result(channels.begin(), channels.end());
  result.erase(-1);
  return result;
}

/// Of a picture without opacity, as if it had one.
Image opaque(const Image& image) {
  Image result(image.width(), image.height(), {"A"});
  std::ranges::fill(result.channel(0), 1.0f);
  return result;
}

/// The channel that makes one number of each pixel: opacity where the picture has one that is not 1
/// everywhere, else the mean of red, green and blue.
constexpr std::string_view one_number = "number";

/// The opacity of a picture; -1: it has none, or it is 1 everywhere.
int uneven_opacity(const Image& image) {
  const int channel = image.find_channel("A");
  if (channel < 0) return -1;
  return std::ranges::all_of(image.channel(channel), [](float a) { return a == 1; }) ? -1 : channel;
}

/// Those channels of a picture, as their mean.
Image mean_of(const Image& image, const std::array<int, 3>& channels) {
  Image mean(image.width(), image.height(), {"Y"});
  for (const int c : channels)
    if (c >= 0)
      for (size_t i = 0; i < image.pixel_count(); ++i)
        mean.channel(0)[i] += image.channel(c)[i] * (1.0f / 3);
  return mean;
}

/// See PictureWish::gamma.
float decoded(float value, double gamma) {
  return gamma < 0 ? linear_from_srgb(value) : float(std::pow(double(value), gamma));
}

bool is_radiance(float value) { return std::isfinite(value) && value >= 0; }

/// Pixels whose values no light and no surface has.
struct BadColours {
  size_t count = 0, first = 0;
  bool has_infinite = false;
  float largest = 0;  ///< of the values that are right
};

/// Repairs them, see PictureReader::read().
BadColours repair(Image& image, const std::array<int, 3>& channels) {
  BadColours bad;
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    bool is_bad = false;
    for (const int c : channels) {
      if (c < 0) continue;
      const float value = image.channel(c)[i];
      if (is_radiance(value)) bad.largest = std::max(bad.largest, value);
      is_bad = is_bad || !is_radiance(value);
    }
    if (is_bad && bad.count++ == 0) bad.first = i;
  }
  if (bad.count == 0) return bad;
  for (const int c : channels) {
    if (c < 0) continue;
    for (float& value : image.channel(c)) {
      if (is_radiance(value)) continue;
      const bool is_infinite = value > 0;
      bad.has_infinite = bad.has_infinite || is_infinite;
      value = is_infinite ? bad.largest : 0;
    }
  }
  return bad;
}

}  // namespace

std::vector<Parameter> picture_parameters(const std::string& of_file,
                                          std::vector<Parameter> others) {
  std::vector<Parameter> rows = {
      file_parameter("filename",
                     "EXR, HDR, PFM, TIFF, PNG, JPEG, WebP, BMP, TGA or PPM file" + of_file),
      array_parameter("data", {},
                      "Picture [rows, columns] or [rows, columns, 1, 3 or 4] from a program's "
                      "buffer, instead of the file: uint8, uint16, float32 or float64; or the "
                      "bytes of such a file, uint8.")
          .instead_of("filename")};
  for (Parameter& other : others) rows.push_back(std::move(other));
  return rows;
}

Parameter gamma_parameter() {
  return number_parameter("gamma", 0,
                          "Exponent that makes stored values linear. 1: they are linear; -1: they "
                          "are sRGB; 0: the usual encoding of the file's format.")
      .range(-1, 10);
}

double gamma_of(const Arguments& arguments) {
  const double gamma = arguments.number("gamma");
  if (gamma < 0 && gamma != -1)
    throw Error(ErrorKind::input, fmt::format("'gamma' is {}", gamma),
                "give a power above 0, or -1 for sRGB", arguments.place_of("gamma"));
  return gamma;
}

std::string picture_name(const Arguments& arguments) {
  if (arguments.array("data")) return "picture 'data'";
  return fmt::format("picture '{}'", arguments.text("filename"));
}

Place picture_place(const Arguments& arguments) {
  return arguments.place_of(arguments.array("data") ? "data" : "filename");
}

PictureReader::PictureReader(int64_t memory_bytes)
    : budget_bytes_(memory_bytes), left_bytes_(memory_bytes) {}

PictureReader::Use PictureReader::use_since(const Mark& mark) const {
  return {mark.left_bytes - left_bytes_,
          {warnings_.begin() + std::ptrdiff_t(mark.warnings), warnings_.end()}};
}

bool PictureReader::account(const Use& use) {
  if (use.bytes > left_bytes_) return false;
  left_bytes_ -= use.bytes;
  warnings_.insert(warnings_.end(), use.warnings.begin(), use.warnings.end());
  return true;
}

Image PictureReader::chosen(Image image, const Arguments& arguments, const PictureWish& wish) {
  if (wish.channels == one_number) {
    const bool has_opacity = uneven_opacity(image) >= 0;
    image = chosen(std::move(image), arguments, {wish.gamma, has_opacity ? "a" : ""});
    const std::array<int, 3> shown = *colour_channels(image.channel_names());
    return distinct(shown).size() == 1 ? std::move(image) : mean_of(image, shown);
  }
  const std::vector<std::string>& names = image.channel_names();
  const auto channels = picture_channels(names, wish.channels);
  const bool wants_opacity = wish.channels == "a" || wish.channels == "A";
  if (!channels && wants_opacity && colour_channels(names))
    return chosen(opaque(image), arguments, wish);
  if (!channels) fail_without(image, arguments, wish.channels);
  const bool is_opacity = names[size_t(std::max((*channels)[0], 0))] == "A";
  const bool is_linear = wish.gamma == 0 || wish.gamma == 1 || is_opacity;
  if (colour_channels(names) != channels) {
    if (wish.channels.empty())
      warnings_.push_back(fmt::format(
          "{} has several layers, and none of them is the picture itself: channel '{}' is taken, "
          "and what goes with it",
          picture_name(arguments), names[size_t((*channels)[0])]));
    image = under_usual_names(image, *channels);
  }
  if (!is_linear)
    for (const int c : distinct(*colour_channels(image.channel_names())))
      for (float& value : image.channel(c)) value = decoded(value, wish.gamma);
  return image;
}

Image PictureReader::read(const Arguments& arguments, int64_t kept_bytes_per_pixel,
                          const PictureWish& wish) {
  ReadOptions options;
  options.srgb_to_linear = wish.gamma == 0;
  options.whole_picture = true;
  options.only_colours = wish.channels != one_number;
  if (options.only_colours) options.channels = wish.channels;
  options.memory_bytes = left_bytes_;
  options.kept_bytes_per_pixel = kept_bytes_per_pixel;
  options.memory_remedy = fmt::format(
      "allow pictures more memory than {:.3g} MB in all (texture memory), or give smaller ones",
      double(budget_bytes_) / 1e6);
  Image image = chosen(read_at(arguments, options), arguments, wish);
  ++read_count_;
  left_bytes_ -= int64_t(image.pixel_count()) * kept_bytes_per_pixel;
  const BadColours bad = repair(image, *colour_channels(image.channel_names()));
  if (bad.count > 0)
    warnings_.push_back(fmt::format(
        "{}: {} of its {} pixels {} negative or not finite, the first at ({}, {}): "
        "taken as {}",
        picture_name(arguments), bad.count, image.pixel_count(), bad.count == 1 ? "is" : "are",
        bad.first % size_t(image.width()), bad.first / size_t(image.width()),
        bad.has_infinite ? fmt::format("0, infinite ones as {:.4g}, the largest of the others",
                                       double(bad.largest))
                         : std::string("0")));
  return image;
}

}  // namespace kaustik
