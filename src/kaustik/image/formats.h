#pragma once
// One encoder and one decoder per file format, between an Image and the bytes of a file. Only for
// image_io.cpp: decoders throw std::exception for bytes that are no such image, without the path.

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/image/image.h"

namespace kaustik::formats {

using Bytes = std::vector<uint8_t>;
using ByteView = std::span<const uint8_t>;

/// What a decoder throws, and an encoder where the format cannot hold the image: the reason alone.
struct BadImage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws if an image is too large for this machine, or has more pixels than `file_size` bytes can
/// possibly hold at `most_pixels_per_byte`: a corrupt header must not make us allocate gigabytes.
void check_header_size(int64_t width, int64_t height, int64_t channels, size_t file_size,
                       double most_pixels_per_byte);

/// "Y", "Y A", "R G B" or "R G B A" for 1 to 4 channels.
std::vector<std::string> channel_names_for(int channel_count);
/// Decodes the sRGB curve of all channels but "A".
void linearise(Image& image);

/// Metadata as lines "key=value", and back (all as strings).
std::string text_of(const MetadataValue& value);
std::string metadata_lines(const Image& image);
void set_metadata_from_lines(Image& image, std::string_view lines);

void append(Bytes& bytes, std::string_view text);

Bytes encode_exr(const Image& image, bool half);
Image decode_exr(ByteView file);

Bytes encode_hdr(const Image& image, const std::string& layer);
Image decode_hdr(ByteView file);

Bytes encode_pfm(const Image& image, const std::string& layer);
Image decode_pfm(ByteView file);

Bytes encode_ppm(const Image& display_linear);
Image decode_pnm(ByteView file);  ///< values as encoded in the file, over their maximum

Bytes encode_logluv_tiff(const Image& image, const std::string& layer);
Bytes encode_srgb_tiff(const Image& display_linear);
Image decode_tiff(ByteView file);

Bytes encode_png(const Image& display_linear);
Image decode_png(ByteView file);

Bytes encode_jpeg(const Image& display_linear, int quality);
Image decode_jpeg(ByteView file);

}  // namespace kaustik::formats
