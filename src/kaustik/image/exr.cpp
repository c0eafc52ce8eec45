#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescriptionAttribute.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "kaustik/image/formats.h"
#include "kaustik/image/primaries.h"

namespace kaustik::formats {
namespace {

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
  size_t file_size() const { return file_.size(); }
  bool at_empty_header() const { return position_ >= file_.size() || file_[position_] == 0; }

 private:
  ByteView file_;
  size_t position_ = 0;
};

void set_metadata_from_header(Image& image, const Imf::Header& header) {
  for (auto entry = header.begin(); entry != header.end(); ++entry) {
    const std::string key = entry.name();
    if (is_exr_attribute(key)) continue;
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

int64_t extent(int from, int to) { return int64_t(to) - int64_t(from) + 1; }

/// How many bytes of pixels a byte of the file can become.
double densest_compression(Imf::Compression compression) {
  constexpr double deflate = 1100;
  const bool is_dwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
  return is_dwa ? 64 * deflate : deflate;  // DWA deflates one value per block of 8 × 8
}

/// Lines that the library decodes at once.
int lines_at_once(const Imf::Header& header) {
  if (header.hasTileDescription()) return int(std::min(header.tileDescription().ySize, 1u << 30));
  switch (header.compression()) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 1;
  }
}

/// Sizes of one part, before the library allocates anything by them.
void check_header(const Imf::Header& header, size_t file_size, const ReadOptions& options) {
  const Imath::Box2i window = header.dataWindow();
  double pixel_bytes = 0;
  for (auto entry = header.channels().begin(); entry != header.channels().end(); ++entry)
    pixel_bytes += entry.channel().type == Imf::HALF ? 2 : 4;
  if (pixel_bytes == 0) throw BadImage("it has no channels");
  const double density = densest_compression(header.compression()) / pixel_bytes;
  const int64_t width = extent(window.min.x, window.max.x);
  const int64_t height = extent(window.min.y, window.max.y);
  check_promise({width, height, 0, 0, density}, file_size, {});
  // The library holds the lines packed, unpacked and in between.
  const int64_t lines = std::min<int64_t>(height, lines_at_once(header));
  check_promise({width, lines, 0, int64_t(3 * pixel_bytes), density}, file_size, options);
  if (!header.hasTileDescription()) return;
  const Imf::TileDescription& tiles = header.tileDescription();
  // Tiles may be larger than what the image uses of them, but the library allocates whole ones.
  constexpr int64_t largest_tile_side = 4096;
  if (std::max(tiles.xSize, tiles.ySize) > largest_tile_side)
    check_promise({tiles.xSize, tiles.ySize, 0, int64_t(3 * pixel_bytes), density}, file_size,
                  options);
}

/// Whether the file has parts.
bool check_headers(ByteView file, const ReadOptions& options) {
  MemoryInput input(file);
  char start[8];
  input.read(start, sizeof(start));
  const int version = uint8_t(start[4]) | uint8_t(start[5]) << 8 | uint8_t(start[6]) << 16;
  const bool has_parts = (version & Imf::MULTI_PART_FILE_FLAG) != 0;
  do {
    Imf::Header header;
    int header_version = version;
    header.readFrom(input, header_version);
    check_header(header, file.size(), options);
  } while (has_parts && !input.at_empty_header());
  return has_parts;
}

/// The image that lines of the data window go into: of its size, or of the display window's.
class Target {
 public:
  Target(const Imf::Header& header, const std::vector<std::string>& names, size_t file_size,
         const ReadOptions& options)
      : window_(header.dataWindow()) {
    const Imath::Box2i display = header.displayWindow();
    const int64_t x = int64_t(window_.min.x) - display.min.x;
    const int64_t y = int64_t(window_.min.y) - display.min.y;
    const int64_t width = extent(display.min.x, display.max.x);
    const int64_t height = extent(display.min.y, display.max.y);
    // The picture may be too large for one image, of which this is a window.
    if (options.whole_picture) check_image_size(width, height, 0);
    constexpr int64_t largest = 1 << 30;
    if (std::min(width, height) < 1 || std::max(width, height) > largest)
      throw BadImage("its display window is empty or too large");
    constexpr int64_t farthest = 1 << 30;
    if (std::max(std::abs(x), std::abs(y)) > farthest)
      throw BadImage("its data window is too far from its display window");
    const bool whole = options.whole_picture;
    const int64_t own_width = extent(window_.min.x, window_.max.x);
    const int64_t own_height = extent(window_.min.y, window_.max.y);
    check_promise({whole ? width : own_width, whole ? height : own_height, int64_t(names.size()), 0,
                   std::numeric_limits<double>::infinity()},
                  file_size, options);
    image = Image(int(whole ? width : own_width), int(whole ? height : own_height), names);
    if (!whole) image.set_frame({int(width), int(height), int(x), int(y)});
    left_ = whole ? x : 0;
    upper_ = whole ? y : 0;
  }

  /// Values `stride` apart, of line y of the file.
  template <typename Value>
  void put(int y, int channel, const Value* line, size_t stride) {
    const int64_t row = upper_ + y - window_.min.y;
    if (row < 0 || row >= image.height()) return;
    const int64_t width = extent(window_.min.x, window_.max.x);
    const int64_t begin = std::max<int64_t>(left_, 0);
    const int64_t end = std::min<int64_t>(left_ + width, image.width());
    for (int64_t x = begin; x < end; ++x)
      image.at(int(x), int(row), channel) = float(line[size_t(x - left_) * stride]);
  }

  Image image;

 private:
  Imath::Box2i window_;
  int64_t left_, upper_;
};

/// Luminance with chroma of half the resolution, which the library puts together.
bool is_luminance_chroma(const Imf::ChannelList& channels) {
  return channels.findChannel("Y") && !channels.findChannel("R") &&
         (channels.findChannel("RY") || channels.findChannel("BY"));
}

Image read_luminance_chroma(MemoryInput& input, const ReadOptions& options) {
  Imf::RgbaInputFile file(input, 0);
  const Imath::Box2i window = file.dataWindow();
  const bool has_alpha = file.header().channels().findChannel("A") != nullptr;
  Target target(file.header(), channel_names_for(has_alpha ? 4 : 3), input.file_size(), options);
  std::vector<Imf::Rgba> line(size_t(extent(window.min.x, window.max.x)));
  file.setFrameBuffer(
      Imf::ComputeBasePointer(line.data(), Imath::V2i(window.min.x, 0), int64_t{1}, size_t{1}, 0),
      1, 0);
  for (int y = window.min.y; y <= window.max.y; ++y) {
    file.readPixels(y);
    const ::half* const values[] = {&line[0].r, &line[0].g, &line[0].b, &line[0].a};
    for (int c = 0; c < target.image.channel_count(); ++c) target.put(y, c, values[c], 4);
  }
  return std::move(target.image);
}

/// A channel of a file, which may have several parts.
struct FileChannel {
  std::string name;          ///< of the image
  std::string name_in_part;  ///< the same, but where another part has that already
  int part = 0;
  bool is_half = false, is_whole = true;  ///< not whole: subsampled
};

/// Adds those of a part. A name that is taken gets that of the part before it, as a layer's.
void add_channels(const Imf::Header& header, int part, std::vector<FileChannel>& channels) {
  std::set<std::string> taken;
  for (const FileChannel& channel : channels) taken.insert(channel.name);
  for (auto entry = header.channels().begin(); entry != header.channels().end(); ++entry) {
    std::string name = entry.name();
    if (taken.contains(name) && header.hasName()) name = header.name() + '.' + name;
    if (!taken.insert(name).second) continue;
    const Imf::Channel& channel = entry.channel();
    channels.push_back({std::move(name), entry.name(), part, channel.type == Imf::HALF,
                        channel.xSampling == 1 && channel.ySampling == 1});
  }
}

/// Those that are to be read.
std::vector<FileChannel> wanted_channels(const std::vector<FileChannel>& all,
                                         const ReadOptions& options) {
  std::vector<std::string> names;
  for (const FileChannel& channel : all) names.push_back(channel.name);
  // Of several layers whoever asks for the picture chooses one, and tells it.
  const auto colours = !options.only_colours      ? std::nullopt
                       : options.channels.empty() ? colour_channels(names)
                                                  : picture_channels(names, options.channels);
  std::vector<FileChannel> wanted;
  for (size_t i = 0; i < all.size(); ++i)
    if (!colours || std::find(colours->begin(), colours->end(), int(i)) != colours->end())
      wanted.push_back(all[i]);
  for (const FileChannel& channel : wanted)
    if (!channel.is_whole)
      throw BadImage(
          fmt::format("channel '{}' is subsampled, which is not supported", channel.name));
  return wanted;
}

/// Of the wanted channels those that this part has.
template <typename Part>
void read_part_lines(Part& file, int part, const std::vector<FileChannel>& wanted, Target& target) {
  const Imath::Box2i window = file.header().dataWindow();
  const size_t width = size_t(extent(window.min.x, window.max.x));
  const auto count = size_t(std::count_if(wanted.begin(), wanted.end(),
                                          [&](const FileChannel& c) { return c.part == part; }));
  std::vector<float, ZeroedAllocator<float>> line(width * count);
  Imf::FrameBuffer buffer;
  std::vector<int> targets;
  for (size_t c = 0; c < wanted.size(); ++c) {
    if (wanted[c].part != part) continue;
    Imf::Slice slice = Imf::Slice::Make(Imf::FLOAT, line.data() + targets.size() * width,
                                        Imath::V2i(window.min.x, 0), int64_t(width), 1);
    slice.yStride = 0;  // every line comes to the same place
    buffer.insert(wanted[c].name_in_part, slice);
    targets.push_back(int(c));
  }
  if (targets.empty()) return;
  file.setFrameBuffer(buffer);
  for (int y = window.min.y; y <= window.max.y; ++y) {
    file.readPixels(y);
    for (size_t i = 0; i < targets.size(); ++i) target.put(y, targets[i], &line[i * width], 1);
  }
}

Target target_for(const Imf::Header& header, const std::vector<FileChannel>& wanted,
                  size_t file_size, const ReadOptions& options) {
  std::vector<std::string> names;
  for (const FileChannel& channel : wanted) names.push_back(channel.name);
  Target target(header, names, file_size, options);
  for (size_t c = 0; c < wanted.size(); ++c)
    if (!wanted[c].is_half) target.image.set_keeps_floats(int(c));
  return target;
}

Image read_channels(MemoryInput& input, const ReadOptions& options) {
  Imf::InputFile file(input, 0);
  std::vector<FileChannel> all;
  add_channels(file.header(), 0, all);
  const std::vector<FileChannel> wanted = wanted_channels(all, options);
  Target target = target_for(file.header(), wanted, input.file_size(), options);
  read_part_lines(file, 0, wanted, target);
  return std::move(target.image);
}

/// The parts of a file that are pictures of the same window as the first of them. Deep ones, which
/// have many values for a pixel, are none.
std::vector<int> parts_alike(const Imf::MultiPartInputFile& file) {
  std::vector<int> parts;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    const bool is_flat = !header.hasType() || header.type() == Imf::SCANLINEIMAGE ||
                         header.type() == Imf::TILEDIMAGE;
    if (is_flat &&
        (parts.empty() || header.dataWindow() == file.header(parts.front()).dataWindow()))
      parts.push_back(part);
  }
  if (parts.empty()) throw BadImage("none of its parts is a flat picture");
  return parts;
}

Image read_parts(MemoryInput& input, const ReadOptions& options) {
  Imf::MultiPartInputFile file(input, 0);
  const std::vector<int> parts = parts_alike(file);
  std::vector<FileChannel> all;
  for (const int part : parts) add_channels(file.header(part), part, all);
  const std::vector<FileChannel> wanted = wanted_channels(all, options);
  Target target = target_for(file.header(parts.front()), wanted, input.file_size(), options);
  for (const int index : parts) {
    Imf::InputPart part(file, index);
    read_part_lines(part, index, wanted, target);
  }
  return std::move(target.image);
}

/// The red, green and blue of every layer.
void convert_colours(Image& image, const ColourMatrix& matrix) {
  std::map<std::string_view, int> index;
  for (int c = 0; c < image.channel_count(); ++c) index[image.channel_names()[size_t(c)]] = c;
  for (const auto& [name, red] : index) {
    const std::string layer(name.substr(0, name.rfind('.') + 1));
    const auto green = index.find(layer + 'G'), blue = index.find(layer + 'B');
    if (name != layer + 'R' || green == index.end() || blue == index.end()) continue;
    const int channels[] = {red, green->second, blue->second};
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      const Vec3f colour =
          matrix * Vec3f(image.channel(channels[0])[i], image.channel(channels[1])[i],
                         image.channel(channels[2])[i]);
      for (int c = 0; c < 3; ++c) image.channel(channels[c])[i] = colour[c];
    }
  }
}

Primaries primaries_of(const Imf::Header& header) {
  const Imf::Chromaticities& c = Imf::chromaticities(header);
  return {c.red, c.green, c.blue, c.white};
}

}  // namespace

Image decode_exr(ByteView bytes, const ReadOptions& options) try {
  const bool has_parts = check_headers(bytes, options);
  Imf::Header header;
  {
    MemoryInput input(bytes);
    header = Imf::InputFile(input, 0).header();
  }
  MemoryInput input(bytes);
  Image image = is_luminance_chroma(header.channels()) ? read_luminance_chroma(input, options)
                : has_parts                            ? read_parts(input, options)
                                                       : read_channels(input, options);
  if (Imf::hasChromaticities(header))
    if (const auto matrix = rec709_from(primaries_of(header))) convert_colours(image, *matrix);
  set_metadata_from_header(image, header);
  return image;
} catch (const Iex::BaseExc& error) {
  fail_as_told(error.what());
}

}  // namespace kaustik::formats
