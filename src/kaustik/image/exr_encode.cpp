#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
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
  // The name stands in messages, and "memory" tells there what is lacking.
  MemoryOutput() : OStream("file") {}
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

void insert_metadata(Imf::Header& header, const Image& image) {
  for (const auto& [key, value] : image.metadata()) {
    if (key.empty() || key.size() > 255 || is_exr_attribute(key))
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

/// Red, green, blue or grey of some layer: what people see, and may brighten.
bool is_colour(const std::string& name) {
  const std::string last = name.substr(name.rfind('.') + 1);
  return last == "R" || last == "G" || last == "B" || name == "Y";
}

/// Whether 16-bit floats keep the values to what rounding takes from any, 2⁻¹¹ of them. Near zero
/// they have steps of 2⁻²⁴ instead. So their loss is weighed against all values together; and among
/// colours dim ones beside bright ones must not vanish either: no more than one in 1000 may lose
/// more than a hundredth of itself.
bool fits_half(const std::string& name, std::span<const float> values) {
  double sum = 0, loss = 0;
  size_t vanishing = 0;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    if (std::fabs(value) > largest_half) return false;
    const float error = std::fabs(float(::half(value)) - value);
    sum += double(std::fabs(value));
    loss += double(error);
    if (error > 0.01f * std::fabs(value)) ++vanishing;
  }
  return loss <= std::ldexp(sum, -11) && (!is_colour(name) || vanishing * 1000 <= values.size());
}

}  // namespace

bool is_exr_attribute(const std::string& key) {
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

Bytes encode_exr(const Image& image, bool half) {
  const PictureFrame& frame = image.frame();
  const Imath::Box2i display({0, 0}, {frame.width - 1, frame.height - 1});
  const Imath::Box2i data({frame.x, frame.y},
                          {frame.x + image.width() - 1, frame.y + image.height() - 1});
  Imf::Header header(display, data);
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
    if (half && !image.keeps_floats(c) && fits_half(name, values)) {
      header.channels().insert(name, Imf::Channel(Imf::HALF));
      std::vector<::half>& converted = halves.emplace_back(pixels);
      std::transform(values.begin(), values.end(), converted.begin(),
                     [](float value) { return ::half(value); });
      buffer.insert(name, Imf::Slice::Make(Imf::HALF, converted.data(), data, sizeof(::half),
                                           sizeof(::half) * width));
    } else {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), data, sizeof(float),
                                           sizeof(float) * width));
    }
  }
  MemoryOutput output;
  try {
    Imf::OutputFile file(output, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height());
  } catch (const Iex::BaseExc& error) {
    fail_as_told(error.what());
  }
  return std::move(output.bytes);
}

}  // namespace kaustik::formats
