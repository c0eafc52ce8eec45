#pragma once
// One encoder and one decoder per file format, between an Image and the bytes of a file. Only for
// image_io.cpp: decoders throw std::exception for bytes that are no such image, without the path.

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/image/image_io.h"

namespace kaustik::formats {

using Bytes = std::vector<uint8_t>;
using ByteView = std::span<const uint8_t>;

/// What a decoder throws, and an encoder where the format cannot hold the image: the reason alone.
struct BadImage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a decoder throws where the image would need more memory than it may take.
struct TooLittleMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws what a library's error text tells: std::bad_alloc where memory was lacking, else
/// BadImage.
[[noreturn]] void fail_as_told(const std::string& error);

/// Of a picture that a header promises.
struct Promise {
  int64_t width = 0, height = 0;
  int64_t channels = 0;         ///< that the image will have
  int64_t work_bytes = 0;       ///< per pixel that decoding takes beside the image
  double most_pixels_per_byte;  ///< that the format can pack into a byte of a file
};
/// Throws before anything is allocated: Error(input) for more than max_image_pixels, BadImage for
/// more than a file of `file_size` bytes can hold, TooLittleMemory for more than `options` allow to
/// the image and the file, which is in memory too.
void check_promise(const Promise& promise, size_t file_size, const ReadOptions& options);

/// Memory whose pages cost nothing until they are written.
using WorkBytes = std::vector<uint8_t, ZeroedAllocator<uint8_t>>;

/// Sets pixel (x, y) of all channels from interleaved 8-bit samples, 255 being 1.
void set_pixel(Image& image, int x, int y, const uint8_t* samples);

/// "Y", "Y A", "R G B" or "R G B A" for 1 to 4 channels.
std::vector<std::string> channel_names_for(int channel_count);
/// Decodes the sRGB curve of all channels but "A".
void linearise(Image& image);

/// Metadata as lines "key=value", and back (all as strings).
std::string text_of(const MetadataValue& value);
std::string metadata_lines(const Image& image);
void set_metadata_from_lines(Image& image, std::string_view lines);

void append(Bytes& bytes, std::string_view text);

/// Whether EXR itself gives an attribute of this name a meaning.
bool is_exr_attribute(const std::string& key);
Bytes encode_exr(const Image& image, bool half);
Image decode_exr(ByteView file, const ReadOptions& options);

Bytes encode_hdr(const Image& image, const std::string& layer);
Image decode_hdr(ByteView file, const ReadOptions& options);

Bytes encode_pfm(const Image& image, const std::string& layer);
Image decode_pfm(ByteView file, const ReadOptions& options);

Bytes encode_ppm(const Image& display_linear);
/// Values as encoded in the file, over their maximum.
Image decode_pnm(ByteView file, const ReadOptions& options);

Bytes encode_logluv_tiff(const Image& image, const std::string& layer);
Bytes encode_srgb_tiff(const Image& display_linear);
Image decode_tiff(ByteView file, const ReadOptions& options);

Bytes encode_png(const Image& display_linear);
Image decode_png(ByteView file, const ReadOptions& options);

Bytes encode_jpeg(const Image& display_linear, int quality);
Image decode_jpeg(ByteView file, const ReadOptions& options);

Image decode_webp(ByteView file, const ReadOptions& options);
Image decode_bmp(ByteView file, const ReadOptions& options);
Image decode_tga(ByteView file, const ReadOptions& options);

}  // namespace kaustik::formats
