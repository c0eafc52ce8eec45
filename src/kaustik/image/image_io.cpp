#include "kaustik/image/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <new>

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
  Bytes (*encode_shown)(const Image& shown, int jpeg_quality);  ///< null: only for radiance
};

Bytes write_exr(const Image& image, const WriteOptions& options) {
  return formats::encode_exr(image, options.exr_half);
}
Bytes write_hdr(const Image& image, const WriteOptions& options) {
  return formats::encode_hdr(image, options.layer);
}
Bytes write_pfm(const Image& image, const WriteOptions& options) {
  return formats::encode_pfm(image, options.layer);
}
Bytes write_logluv(const Image& image, const WriteOptions& options) {
  return formats::encode_logluv_tiff(image, options.layer);
}

Bytes show_png(const Image& shown, int) { return formats::encode_png(shown); }
Bytes show_ppm(const Image& shown, int) { return formats::encode_ppm(shown); }
Bytes show_tiff(const Image& shown, int) { return formats::encode_srgb_tiff(shown); }

template <Bytes (*encode)(const Image&, int)>
Bytes tone_mapped(const Image& image, const WriteOptions& options) {
  const auto tone = options.tone ? options.tone : make_tone_operator("histogram");
  return encode(tone_map(image, *tone, options.layer, options.view), options.jpeg_quality);
}

constexpr Writer writers[] = {{".exr", write_exr, nullptr},
                              {".hdr", write_hdr, nullptr},
                              {".pfm", write_pfm, nullptr},
                              {".tif", write_logluv, show_tiff},
                              {".tiff", write_logluv, show_tiff},
                              {".png", tone_mapped<show_png>, show_png},
                              {".jpg", tone_mapped<formats::encode_jpeg>, formats::encode_jpeg},
                              {".jpeg", tone_mapped<formats::encode_jpeg>, formats::encode_jpeg},
                              {".ppm", tone_mapped<show_ppm>, show_ppm}};

/// In lower case.
std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

/// Throws for an extension that is unknown, or `for_display` none of a format for displays.
const Writer& writer_for(const std::string& path, bool for_display) {
  const std::string extension = extension_of(path);
  std::string known;
  for (const Writer& writer : writers) {
    if (for_display && !writer.encode_shown) continue;
    if (extension == writer.extension) return writer;
    known += std::string(known.empty() ? "" : ", ") + writer.extension;
  }
  const std::string found = extension.empty() ? std::string("it has no extension")
                            : for_display
                                ? fmt::format("'{}' is no format for displays", extension)
                                : fmt::format("it has the unknown extension '{}'", extension);
  throw Error(ErrorKind::input, fmt::format("cannot write '{}': {}", path, found),
              "give the name one of " + known);
}

/// Encodes by calling `encode`; every problem names the file.
template <typename Encode>
Bytes encoded(const Image& image, const std::string& path, const Encode& encode) {
  if (image.empty())
    throw Error(ErrorKind::input, fmt::format("cannot write '{}': the image is empty", path),
                "give it a size and channels");
  try {
    return encode();
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), fmt::format("cannot write '{}': {}", path, problem.message),
                problem.remedy);
  } catch (const formats::BadImage& error) {
    throw Error(ErrorKind::input, fmt::format("cannot write '{}': {}", path, error.what()),
                "choose another format");
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::system,
                fmt::format("cannot write '{}': there is not enough memory for it", path),
                "free some memory, or choose a smaller image");
  } catch (const std::exception& error) {
    throw Error(ErrorKind::system, fmt::format("cannot write '{}': {}", path, error.what()),
                "choose another format");
  }
}

struct Reader {
  std::string_view start;
  Image (*decode)(ByteView, const ReadOptions&);
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
                              {"\xff\xd8\xff", formats::decode_jpeg},
                              {"RIFF", formats::decode_webp},
                              {"BM", formats::decode_bmp}};

Image decode(ByteView file, const std::string& path, const ReadOptions& options) {
  if (file.empty()) throw formats::BadImage("the file is empty");
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  for (const Reader& reader : readers)
    if (text.starts_with(reader.start)) return reader.decode(file, options);
  // The format has no mark at its start.
  if (extension_of(path) == ".tga") return formats::decode_tga(file, options);
  throw formats::BadImage("it is no image of a known format");
}

[[noreturn]] void refuse_for_machine(const std::string& name, const std::string& reason,
                                     const std::string& remedy) {
  throw Error(ErrorKind::system, fmt::format("cannot read image '{}': {}", name, reason), remedy);
}

void check_file_size(uint64_t bytes, const std::string& name, const ReadOptions& options) {
  if (double(bytes) > double(options.memory_bytes))
    refuse_for_machine(name,
                       fmt::format("the file alone takes {:.3g} MB of memory, and it may take "
                                   "{:.3g} MB",
                                   double(bytes) / 1e6, double(options.memory_bytes) / 1e6),
                       options.memory_remedy);
}

}  // namespace

Image read_image_beside(const std::string& path, int64_t kept_bytes_per_pixel, int images) {
  ReadOptions options;
  options.memory_bytes /= images;
  options.kept_bytes_per_pixel = kept_bytes_per_pixel;
  return read_image(path, options);
}

Image read_image(const std::string& path, const ReadOptions& options) {
  std::error_code unknown;  // who reads it will tell
  const auto file_size = std::filesystem::file_size(path, unknown);
  if (!unknown) check_file_size(file_size, path, options);
  return read_image(read_file(path), path, options);
}

Image read_image(ByteView file, const std::string& name, const ReadOptions& options) {
  check_file_size(file.size(), name, options);
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorKind::input, fmt::format("cannot read image '{}': {}", name, reason),
                "give a complete EXR, HDR, PFM, TIFF, PNG, JPEG, WebP, BMP, TGA, PPM or PGM file");
  };
  try {
    Image image = decode(file, name, options);
    if (options.srgb_to_linear && image.is_srgb_encoded()) formats::linearise(image);
    return image;
  } catch (const formats::TooLittleMemory& error) {
    refuse_for_machine(name, error.what(), options.memory_remedy);
  } catch (const std::bad_alloc&) {
    refuse_for_machine(name, "there is not enough memory for it", options.memory_remedy);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    if (error.kind() == ErrorKind::input) refuse(problem.message);
    refuse_for_machine(name, problem.message, problem.remedy);
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  return {};
}

std::vector<uint8_t> encode_image(const Image& image, const std::string& path,
                                  const WriteOptions& options) {
  return encoded(image, path, [&] { return writer_for(path, false).encode(image, options); });
}

std::vector<uint8_t> encode_shown_image(const Image& shown, const std::string& path,
                                        int jpeg_quality) {
  return encoded(shown, path,
                 [&] { return writer_for(path, true).encode_shown(shown, jpeg_quality); });
}

void write_image(const Image& image, const std::string& path, const WriteOptions& options) {
  check_writable(path);
  write_file_atomically(path, encode_image(image, path, options));
}

void write_shown_image(const Image& shown, const std::string& path, int jpeg_quality) {
  check_shown_writable(path);
  write_file_atomically(path, encode_shown_image(shown, path, jpeg_quality));
}

bool holds_layers(const std::string& path) { return extension_of(path) == ".exr"; }

void check_extension(const std::string& path) { writer_for(path, false); }

void check_shown_extension(const std::string& path) { writer_for(path, true); }

void check_writable(const std::string& path) {
  check_output_path(path);
  check_extension(path);
}

void check_shown_writable(const std::string& path) {
  check_output_path(path);
  check_shown_extension(path);
}

}  // namespace kaustik
