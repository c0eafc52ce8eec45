#include "kaustik/image/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/image/formats.h"

namespace kaustik {
namespace {

using formats::Bytes;
using formats::ByteView;

struct Writer {
  const char* extension;
  Bytes (*encode)(const Image&, const WriteOptions&);
};

Image shown(const Image& image, const WriteOptions& options) {
  Image picture = tone_map(image, options.tone_mapping, options.layer);
  for (const auto& [key, value] : image.metadata()) picture.set_metadata(key, value);
  return picture;
}

Bytes write_exr(const Image& image, const WriteOptions& options) {
  return formats::encode_exr(image, options.exr_half);
}
Bytes write_hdr(const Image& image, const WriteOptions& options) {
  return formats::encode_hdr(image, options.layer);
}
Bytes write_pfm(const Image& image, const WriteOptions& options) {
  return formats::encode_pfm(image, options.layer);
}
Bytes write_tiff(const Image& image, const WriteOptions& options) {
  return formats::encode_tiff(image, options.layer);
}
Bytes write_png(const Image& image, const WriteOptions& options) {
  return formats::encode_png(shown(image, options));
}
Bytes write_jpeg(const Image& image, const WriteOptions& options) {
  return formats::encode_jpeg(shown(image, options), options.jpeg_quality);
}
Bytes write_ppm(const Image& image, const WriteOptions& options) {
  return formats::encode_ppm(shown(image, options));
}

constexpr Writer writers[] = {{".exr", write_exr},  {".hdr", write_hdr},   {".pfm", write_pfm},
                              {".tif", write_tiff}, {".tiff", write_tiff}, {".png", write_png},
                              {".jpg", write_jpeg}, {".jpeg", write_jpeg}, {".ppm", write_ppm}};

const Writer& writer_for(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  std::string known;
  for (const Writer& writer : writers) {
    if (extension == writer.extension) return writer;
    known += std::string(known.empty() ? "" : ", ") + writer.extension;
  }
  const std::string found = extension.empty()
                                ? std::string("no extension")
                                : fmt::format("the unknown extension '{}'", extension);
  throw Error(ErrorKind::input, fmt::format("cannot write '{}': it has {}", path, found),
              "give the name one of " + known);
}

struct Reader {
  std::string_view start;
  Image (*decode)(ByteView);
};

constexpr Reader readers[] = {{"\x76\x2f\x31\x01", formats::decode_exr},
                              {"#?", formats::decode_hdr},
                              {"PF", formats::decode_pfm},
                              {"Pf", formats::decode_pfm},
                              {"P2", formats::decode_pnm},
                              {"P3", formats::decode_pnm},
                              {"P5", formats::decode_pnm},
                              {"P6", formats::decode_pnm},
                              {std::string_view("II*\0", 4), formats::decode_tiff},
                              {std::string_view("MM\0*", 4), formats::decode_tiff},
                              {std::string_view("II+\0", 4), formats::decode_tiff},
                              {std::string_view("MM\0+", 4), formats::decode_tiff},
                              {"\x89PNG\r\n\x1a\n", formats::decode_png},
                              {"\xff\xd8\xff", formats::decode_jpeg}};

Image decode(ByteView file) {
  if (file.empty()) throw formats::BadImage("the file is empty");
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  for (const Reader& reader : readers)
    if (text.starts_with(reader.start)) return reader.decode(file);
  throw formats::BadImage("it is no image of a known format");
}

}  // namespace

Image read_image(const std::string& path, const ReadOptions& options) {
  const std::vector<uint8_t> file = read_file(path);
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorKind::input, fmt::format("cannot read image '{}': {}", path, reason),
                "give a complete EXR, HDR, PFM, TIFF, PNG, JPEG, PPM or PGM file");
  };
  try {
    Image image = decode(file);
    if (options.srgb_to_linear && image.is_srgb_encoded()) formats::linearise(image);
    return image;
  } catch (const Error& error) {
    refuse(error.problems().front().message);
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  return {};
}

void write_image(const Image& image, const std::string& path, const WriteOptions& options) {
  check_writable(path);
  if (image.empty())
    throw Error(ErrorKind::input, fmt::format("cannot write '{}': the image is empty", path),
                "give it a size and channels");
  Bytes bytes;
  try {
    bytes = writer_for(path).encode(image, options);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), fmt::format("cannot write '{}': {}", path, problem.message),
                problem.remedy);
  } catch (const formats::BadImage& error) {
    throw Error(ErrorKind::input, fmt::format("cannot write '{}': {}", path, error.what()),
                "choose another format");
  } catch (const std::exception& error) {
    throw Error(ErrorKind::system, fmt::format("cannot write '{}': {}", path, error.what()),
                "choose another format or a smaller image");
  }
  write_file_atomically(path, bytes);
}

void check_writable(const std::string& path) {
  check_output_path(path);
  writer_for(path);
}

}  // namespace kaustik
