#include "kaustik/image/stitch.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

/// Of what takes time in each part.
constexpr const char* summed_key = "render_seconds";
/// What is true of the whole if it is of any part.
constexpr const char* lasting_key = "incomplete";

/// Of windows only.
bool is_of_window(const std::string& key) { return key == crop_window_key; }

[[noreturn]] void refuse(const std::string& message, const std::string& remedy) {
  throw Error(ErrorKind::input, message, remedy);
}

bool are_same_bits(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}

}  // namespace

void Stitcher::begin(const std::string& name, const Image& part) {
  const PictureFrame& frame = part.frame();
  whole_ = Image(frame.width, frame.height, part.channel_names());
  whole_.set_srgb_encoded(part.is_srgb_encoded());
  for (const auto& [key, value] : part.metadata())
    if (!is_of_window(key)) whole_.set_metadata(key, value);
  first_name_ = name;
  known_.assign(whole_.pixel_count(), false);
}

void Stitcher::check(const std::string& name, const Image& part) const {
  const PictureFrame& frame = part.frame();
  if (frame.width != whole_.width() || frame.height != whole_.height())
    refuse(fmt::format("'{}' is part of a picture of {} × {} pixels, '{}' of one of {} × {}", name,
                       frame.width, frame.height, first_name_, whole_.width(), whole_.height()),
           "give parts of one picture: EXR files rendered with the same film size and other crop "
           "windows");
  if (part.channel_names() != whole_.channel_names())
    refuse(fmt::format("'{}' has other channels than '{}'", name, first_name_),
           "render all parts with the same integrator");
}

void Stitcher::note_differing(const std::string& key) {
  if (std::find(differing_.begin(), differing_.end(), key) == differing_.end())
    differing_.push_back(key);
}

void Stitcher::take_metadata(const Image& part) {
  for (const auto& [key, value] : part.metadata()) {
    if (whole_.find_metadata(key) || is_of_window(key)) continue;
    if (key == lasting_key)
      whole_.set_metadata(key, value);
    else
      note_differing(key);
  }
  for (const auto& [key, value] : std::vector(whole_.metadata())) {
    if (key == lasting_key) continue;
    const MetadataValue* other = part.find_metadata(key);
    const double *sum = std::get_if<double>(&value),
                 *more = other ? std::get_if<double>(other) : nullptr;
    if (key == summed_key && sum && more)
      whole_.set_metadata(key, *sum + *more);
    else if (!other || *other != value)
      note_differing(key);
  }
}

void Stitcher::add(const std::string& name, const Image& part) {
  if (whole_.empty())
    begin(name, part);
  else
    take_metadata(part);
  check(name, part);
  for (int c = 0; c < part.channel_count(); ++c)
    if (part.keeps_floats(c)) whole_.set_keeps_floats(c);
  const PictureFrame& frame = part.frame();
  for (int y = std::max(0, -frame.y); y < std::min(part.height(), frame.height - frame.y); ++y)
    for (int x = std::max(0, -frame.x); x < std::min(part.width(), frame.width - frame.x); ++x) {
      const int to_x = x + frame.x, to_y = y + frame.y;
      const size_t pixel = size_t(to_y) * size_t(frame.width) + size_t(to_x);
      for (int c = 0; c < part.channel_count(); ++c) {
        float& value = whole_.at(to_x, to_y, c);
        if (known_[pixel] && !are_same_bits(value, part.at(x, y, c)))
          refuse(fmt::format("'{}' has another value at pixel {}, {} of the picture than a part "
                             "before it",
                             name, to_x, to_y),
                 "give parts that do not overlap");
        value = part.at(x, y, c);
      }
      known_[pixel] = true;
    }
}

Image Stitcher::finish() && {
  const auto missing = std::find(known_.begin(), known_.end(), false);
  if (missing != known_.end() || known_.empty()) {
    const auto pixel = size_t(missing - known_.begin());
    const size_t width = size_t(std::max(1, whole_.width()));
    refuse(fmt::format("{} of {} pixels are in no part, the first is {}, {}",
                       std::count(known_.begin(), known_.end(), false), known_.size(),
                       pixel % width, pixel / width),
           "render the parts that are missing by the film's crop window, too");
  }
  Image result(whole_.width(), whole_.height(), whole_.channel_names());
  for (int c = 0; c < result.channel_count(); ++c) {
    std::copy(whole_.channel(c).begin(), whole_.channel(c).end(), result.channel(c).begin());
    if (whole_.keeps_floats(c)) result.set_keeps_floats(c);
  }
  result.set_srgb_encoded(whole_.is_srgb_encoded());
  for (const auto& [key, value] : whole_.metadata())
    if (std::find(differing_.begin(), differing_.end(), key) == differing_.end())
      result.set_metadata(key, value);
  return result;
}

}  // namespace kaustik
