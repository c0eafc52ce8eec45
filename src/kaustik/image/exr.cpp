#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescriptionAttribute.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kaustik/base/error.h"
#include "kaustik/image/formats.h"
#include "kaustik/image/photometry.h"

namespace kaustik::formats {
namespace {

constexpr float largest_half = 65504;

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("memory") {}
  void write(const char data[], int count) override {
    const size_t end = position_ + size_t(count);
    if (end > bytes.size()) bytes.resize(end);
    std::memcpy(bytes.data() + position_, data, size_t(count));
    position_ = end;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = size_t(position); }

  Bytes bytes;

 private:
  size_t position_ = 0;
};

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(ByteView file) : IStream("file"), file_(file) {}
  bool read(char data[], int count) override {
    if (count < 0 || position_ > file_.size() || size_t(count) > file_.size() - position_)
      throw BadImage("the file is truncated");
    std::memcpy(data, file_.data() + position_, size_t(count));
    position_ += size_t(count);
    return position_ < file_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = size_t(position); }
  void clear() override {}
  bool at_empty_header() const { return position_ >= file_.size() || file_[position_] == 0; }

 private:
  ByteView file_;
  size_t position_ = 0;
};

/// Attributes that the format itself gives a meaning.
bool is_reserved(const std::string& key) {
  static constexpr const char* names[] = {"channels",
                                          "chunkCount",
                                          "compression",
                                          "dataWindow",
                                          "displayWindow",
                                          "lineOrder",
                                          "pixelAspectRatio",
                                          "screenWindowCenter",
                                          "screenWindowWidth",
                                          "tiles",
                                          "type",
                                          "name",
                                          "version",
                                          "view",
                                          "multiView",
                                          "chromaticities",
                                          "whiteLuminance",
                                          "preview",
                                          "maxSamplesPerPixel",
                                          "dwaCompressionLevel"};
  return std::find(std::begin(names), std::end(names), key) != std::end(names);
}

void insert_metadata(Imf::Header& header, const Image& image) {
  for (const auto& [key, value] : image.metadata()) {
    if (key.empty() || key.size() > 255 || is_reserved(key))
      throw Error(ErrorKind::input, fmt::format("'{}' cannot be a metadata key in EXR", key),
                  "choose another name for it, of 1 to 255 characters");
    const int64_t* integer = std::get_if<int64_t>(&value);
    if (const double* number = std::get_if<double>(&value))
      header.insert(key, Imf::DoubleAttribute(*number));
    else if (integer && *integer >= INT32_MIN && *integer <= INT32_MAX)
      header.insert(key, Imf::IntAttribute(int(*integer)));
    else  // EXR has no 64-bit integers; text keeps every digit
      header.insert(key, Imf::StringAttribute(text_of(value)));
  }
}

void set_metadata_from_header(Image& image, const Imf::Header& header) {
  for (auto entry = header.begin(); entry != header.end(); ++entry) {
    const std::string key = entry.name();
    if (is_reserved(key)) continue;
    const Imf::Attribute& value = entry.attribute();
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&value))
      image.set_metadata(key, text->value());
    else if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(&value))
      image.set_metadata(key, real->value());
    else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&value))
      image.set_metadata(key, double(single->value()));
    else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&value))
      image.set_metadata(key, int64_t(integer->value()));
  }
}

bool fits_half(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float value) {
    return !std::isfinite(value) || std::fabs(value) <= largest_half;
  });
}

int64_t extent(int from, int to) { return int64_t(to) - int64_t(from) + 1; }

/// How many bytes of pixels a byte of the file can become.
double densest_compression(Imf::Compression compression) {
  constexpr double deflate = 1100;
  const bool is_dwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
  return is_dwa ? 64 * deflate : deflate;  // DWA deflates one value per block of 8 × 8
}

/// Sizes of one part, before the library allocates anything by them.
void check_header(const Imf::Header& header, size_t file_size) {
  const Imath::Box2i window = header.dataWindow();
  int64_t channels = 0;
  double pixel_bytes = 0;
  for (auto entry = header.channels().begin(); entry != header.channels().end(); ++entry) {
    ++channels;
    pixel_bytes += entry.channel().type == Imf::HALF ? 2 : 4;
  }
  if (channels == 0) throw BadImage("it has no channels");
  const double most_pixels_per_byte = densest_compression(header.compression()) / pixel_bytes;
  check_header_size(extent(window.min.x, window.max.x), extent(window.min.y, window.max.y),
                    channels, file_size, most_pixels_per_byte);
  if (!header.hasTileDescription()) return;
  const Imf::TileDescription& tiles = header.tileDescription();
  // Tiles may be larger than what the image uses of them, but the library allocates whole ones.
  constexpr int64_t largest_tile_side = 4096;
  if (std::max(tiles.xSize, tiles.ySize) > largest_tile_side)
    check_header_size(tiles.xSize, tiles.ySize, channels, file_size, most_pixels_per_byte);
}

void check_headers(ByteView file) {
  MemoryInput input(file);
  char start[8];
  input.read(start, sizeof(start));
  const int version = uint8_t(start[4]) | uint8_t(start[5]) << 8 | uint8_t(start[6]) << 16;
  const bool has_parts = (version & Imf::MULTI_PART_FILE_FLAG) != 0;
  do {
    Imf::Header header;
    int header_version = version;
    header.readFrom(input, header_version);
    check_header(header, file.size());
  } while (has_parts && !input.at_empty_header());
}

}  // namespace

Bytes encode_exr(const Image& image, bool half) {
  Imf::Header header(image.width(), image.height());
  header.compression() = Imf::ZIP_COMPRESSION;
  // Rec. 709 is what the library assumes; said in the file, no reader has to guess.
  Imf::addChromaticities(header, Imf::Chromaticities());
  Imf::addWhiteLuminance(header, white_efficacy);
  insert_metadata(header, image);

  const size_t pixels = image.pixel_count();
  std::vector<std::vector<::half>> halves;
  Imf::FrameBuffer buffer;
  for (int c = 0; c < image.channel_count(); ++c) {
    const std::string& name = image.channel_names()[size_t(c)];
    const std::span<const float> values = image.channel(c);
    const size_t width = size_t(image.width());
    if (half && fits_half(values)) {
      header.channels().insert(name, Imf::Channel(Imf::HALF));
      std::vector<::half>& converted = halves.emplace_back(pixels);
      std::transform(values.begin(), values.end(), converted.begin(),
                     [](float value) { return ::half(value); });
      buffer.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(converted.data()),
                                     sizeof(::half), sizeof(::half) * width));
    } else {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      // The library only reads through this pointer.
      char* data = const_cast<char*>(reinterpret_cast<const char*>(values.data()));
      buffer.insert(name, Imf::Slice(Imf::FLOAT, data, sizeof(float), sizeof(float) * width));
    }
  }
  MemoryOutput output;
  {
    Imf::OutputFile file(output, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height());
  }
  return std::move(output.bytes);
}

Image decode_exr(ByteView bytes) {
  check_headers(bytes);
  MemoryInput input(bytes);
  Imf::InputFile file(input, 0);
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  std::vector<std::string> names;
  for (auto entry = header.channels().begin(); entry != header.channels().end(); ++entry) {
    if (entry.channel().xSampling != 1 || entry.channel().ySampling != 1)
      throw BadImage(
          fmt::format("channel '{}' is subsampled, which is not supported", entry.name()));
    names.push_back(entry.name());
  }
  Image image(int(extent(window.min.x, window.max.x)), int(extent(window.min.y, window.max.y)),
              names);
  Imf::FrameBuffer buffer;
  for (int c = 0; c < image.channel_count(); ++c) {
    char* data = reinterpret_cast<char*>(image.channel(c).data());
    const size_t stride = sizeof(float);
    buffer.insert(names[size_t(c)], Imf::Slice::Make(Imf::FLOAT, data, window, stride,
                                                     stride * size_t(image.width())));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  set_metadata_from_header(image, header);
  return image;
}

}  // namespace kaustik::formats
