#include "kaustik/image/formats.h"

#include <fmt/format.h>

#include <new>

#include "kaustik/image/photometry.h"

namespace kaustik::formats {

void fail_as_told(const std::string& error) {
  // Some libraries have no other way to tell.
  for (const char* lack : {"emory", "No space for", "ailed to allocate", "bad_alloc"})
    if (error.find(lack) != std::string::npos) throw std::bad_alloc();
  throw BadImage(error);
}

void check_promise(const Promise& promise, size_t file_size, const ReadOptions& options) {
  check_image_size(promise.width, promise.height, 0);
  const double pixels = double(promise.width) * double(promise.height);
  if (pixels > promise.most_pixels_per_byte * double(file_size))
    throw BadImage(fmt::format("{} x {} pixels cannot be in a file of {} bytes", promise.width,
                               promise.height, file_size));
  const double bytes_per_pixel = double(promise.channels) * sizeof(float) +
                                 double(promise.work_bytes) + double(options.kept_bytes_per_pixel);
  const double bytes = pixels * bytes_per_pixel + double(file_size);
  if (bytes > double(options.memory_bytes))
    throw TooLittleMemory(fmt::format(
        "its {} x {} pixels and its file take {:.3g} MB of memory, and it may take {:.3g} MB",
        promise.width, promise.height, bytes / 1e6, double(options.memory_bytes) / 1e6));
}

void set_pixel(Image& image, int x, int y, const uint8_t* samples) {
  for (int c = 0; c < image.channel_count(); ++c) image.at(x, y, c) = float(samples[c]) / 255;
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
