#pragma once
#include <span>
#include <string>

#include "kaustik/image/image.h"
#include "kaustik/image/tone_mapping.h"

namespace kaustik {

struct ReadOptions {
  /// Turn the colours of integer formats (PNG, JPEG, PPM, BMP, TGA, WebP, integer TIFF), which are
  /// sRGB encoded unless the file says otherwise, into linear ones. If not,
  /// Image::is_srgb_encoded() tells.
  bool srgb_to_linear = true;
  /// All of the picture and nothing else, black where the file has no pixels. If not, the pixels of
  /// the file, with Image::frame() to tell their place.
  bool whole_picture = false;
  bool only_colours = false;  ///< of an EXR just the picture_channels() of `channels`
  std::string channels = {};
  /// That reading may take, the file itself included.
  int64_t memory_bytes = default_picture_memory();
  int64_t kept_bytes_per_pixel = 0;  ///< that the caller needs beside the image
  std::string memory_remedy = "give a smaller picture";
};

/// Reads .exr, .hdr, .pfm, .tif, .png, .jpg, .webp, .bmp, .tga and .ppm/.pgm; which one it is, is
/// taken from the contents, for .tga from the name. EXR gives its channels as they are named, and
/// luminance with chroma ("Y", "RY", "BY") as "R", "G", "B"; the others give "R", "G", "B" or "Y",
/// with "A" where there is one. Colours of other primaries that an EXR or HDR names become those of
/// Rec. 709. LogLuv TIFF, HDR and PFM are radiances. Throws Error(input) if the file is missing,
/// truncated, corrupt or not an image, Error(system) if the picture takes more memory than it may
/// or than there is: never more than some 100 MB beyond what the image has to hold.
Image read_image(const std::string& path, const ReadOptions& options = {});
/// The same of a file's bytes, which messages call by this name.
Image read_image(std::span<const uint8_t> file, const std::string& name,
                 const ReadOptions& options = {});
/// The same for a caller that needs so many bytes per pixel beside the image, and that holds so
/// many images like it at a time: they share the memory.
Image read_image_beside(const std::string& path, int64_t kept_bytes_per_pixel, int images = 1);

struct WriteOptions {
  /// EXR channels as 16-bit floats. One is kept at 32 bits if it holds a finite value above 65504,
  /// or values so near to zero that they would lose more than others do by rounding, or if it comes
  /// from a file that has 32 bits (Image::keeps_floats()).
  bool exr_half = true;
  std::shared_ptr<const ToneOperator> tone;  ///< for the 8-bit formats; null: "histogram"
  std::optional<FieldOfView> view;           ///< see tone_map()
  std::string layer;      ///< what the formats with one layer show; "": the picture itself
  int jpeg_quality = 95;  ///< 1 to 100
};

/// Writes by extension, atomically: .exr (all channels, metadata as attributes), .hdr (Radiance
/// RGBE), .pfm, .tif/.tiff (32-bit LogLuv, absolute radiance; luminance by its STONITS tag), and
/// tone mapped with 8 bits .png, .jpg/.jpeg, .ppm. PNG and TIFF carry the metadata as text. Values
/// that a format has no code for, negative ones and NaN in .hdr, infinite ones and NaN in .tif,
/// become 0. Throws Error(input) for what check_writable() finds and for values that the format
/// cannot hold, Error(system) if writing fails; a file that was there before is then unharmed.
void write_image(const Image& image, const std::string& path, const WriteOptions& options = {});

/// Writes what tone_map() made: .png, .jpg/.jpeg, .ppm, and .tif/.tiff with 8-bit sRGB. Else as
/// write_image().
void write_shown_image(const Image& shown, const std::string& path, int jpeg_quality = 95);

/// The bytes that write_image() and write_shown_image() would write to a file of this name.
std::vector<uint8_t> encode_image(const Image& image, const std::string& path,
                                  const WriteOptions& options = {});
std::vector<uint8_t> encode_shown_image(const Image& shown, const std::string& path,
                                        int jpeg_quality = 95);

/// Whether images of such a name have all channels, not the picture's alone: .exr.
bool holds_layers(const std::string& path);

/// Throws Error(input) if write_image() could not write here: unknown extension, folder missing or
/// not writable, path is a folder. To be called before a long render.
void check_writable(const std::string& path);
/// The same for write_shown_image().
void check_shown_writable(const std::string& path);
/// Of that only the extension.
void check_extension(const std::string& path);
void check_shown_extension(const std::string& path);

}  // namespace kaustik
