#include "kaustik/image/formats.h"

#include <fmt/format.h>

#include "kaustik/image/photometry.h"

namespace kaustik::formats {

void check_header_size(int64_t width, int64_t height, int64_t channels, size_t file_size,
                       double most_pixels_per_byte) {
  check_image_size(width, height, channels);
  if (double(width) * double(height) > most_pixels_per_byte * double(file_size))
    throw BadImage(
        fmt::format("{} x {} pixels cannot be in a file of {} bytes", width, height, file_size));
}

std::vector<std::string> channel_names_for(int channel_count) {
  switch (channel_count) {
    case 1:
      return {"Y"};
    case 2:
      return {"Y", "A"};
    case 3:
      return {"R", "G", "B"};
    case 4:
      return {"R", "G", "B", "A"};
    default:
      throw BadImage(fmt::format("images of {} channels are not supported", channel_count));
  }
}

void linearise(Image& image) {
  for (int c = 0; c < image.channel_count(); ++c)
    if (image.channel_names()[size_t(c)] != "A")
      for (float& value : image.channel(c)) value = linear_from_srgb(value);
  image.set_srgb_encoded(false);
}

std::string text_of(const MetadataValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return fmt::format("{}", std::get<int64_t>(value));
}

std::string metadata_lines(const Image& image) {
  std::string lines;
  for (const auto& [key, value] : image.metadata()) lines += key + '=' + text_of(value) + '\n';
  return lines;
}

void set_metadata_from_lines(Image& image, std::string_view lines) {
  while (!lines.empty()) {
    const size_t end = lines.find('\n');
    const std::string_view line = lines.substr(0, end);
    lines = end == std::string_view::npos ? std::string_view() : lines.substr(end + 1);
    const size_t equals = line.find('=');
    if (equals == std::string_view::npos || equals == 0) continue;
    image.set_metadata(std::string(line.substr(0, equals)), std::string(line.substr(equals + 1)));
  }
}

void append(Bytes& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

}  // namespace kaustik::formats
