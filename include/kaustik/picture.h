#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kaustik/estimate.h"
#include "kaustik/export.h"

namespace kaustik::v0 {

namespace details {
struct Access;
struct PictureState;
}  // namespace details

/// How radiance becomes what a display shows: an operator of `kaustik help tonemap` and its
/// parameters as "name=value".
struct ToneSettings {
  std::string name = "histogram";
  std::vector<std::string> parameters = {};
};

/// A picture for a display: sRGB, 8 bits, red, green and blue interleaved, row by row from the top.
struct ShownPicture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

struct WriteSettings {
  ToneSettings tone = {};   ///< of .png, .jpg and .ppm
  bool full_float = false;  ///< .exr with 32 bits instead of 16
  std::string layer = {};   ///< what formats with one layer show; "": the picture itself
  int jpeg_quality = 95;    ///< 1 to 100
};

/// A rectangle of pixels; x and y from the top left.
struct Region {
  int x = 0, y = 0, width = 0, height = 0;
};

/// What a session has rendered at a moment. Immutable; copies share the pixels, and live on after
/// the session.
class KAUSTIK_EXPORT Picture {
 public:
  Picture(const Picture&) = default;  // and nothing is moved: what one is taken from stays whole
  Picture& operator=(const Picture&) = default;
  int width() const noexcept;
  int height() const noexcept;
  /// That it is the mean of; 0: samples of a first pass, or a first look.
  uint32_t passes() const noexcept;
  /// Whether pixels lack samples: no estimate has been made of it yet.
  bool is_incomplete() const noexcept;

  /// "R", "G", "B": the picture itself, linear Rec. 709 in W/(sr·m²). "direct.R" and the like:
  /// layers, if the session keeps them; "error.R": standard errors.
  std::vector<std::string> channels() const;
  /// "" for the picture itself, "direct", "albedo", "error" …
  std::vector<std::string> layers() const;
  bool has_channel(const std::string& name) const noexcept;
  /// All pixels of a channel, row by row from the top; valid as long as the picture or a copy of it
  /// lives. Throws Error if there is none of that name.
  std::span<const float> plane(const std::string& channel) const;
  /// Red, green and blue of a layer into memory of the host's: from one pixel to the next are
  /// `pixel_stride_bytes` (0: 3 floats), from one row to the next `row_stride_bytes` (0: packed,
  /// negative: from the bottom). Throws Error if there is no such layer.
  void copy_rgb(float* target, ptrdiff_t pixel_stride_bytes = 0, ptrdiff_t row_stride_bytes = 0,
                const std::string& layer = {}) const;

  /// Throws Error for an operator or a parameter that nobody knows.
  ShownPicture tonemap(const ToneSettings& tone = {}, const std::string& layer = {}) const;
  /// To .exr, .hdr, .pfm, .tif, .png, .jpg or .ppm; a file that is there is replaced when all is
  /// written. Throws Error.
  void write(const std::string& path, const WriteSettings& settings = {}) const;

  /// Whether pixel(), region(), mean() and relative_error() know errors: Session::picture(), and
  /// snapshots that asked for them.
  bool has_errors() const noexcept;
  // The luminance and its error. They throw Error for what lies beyond the picture, and where
  // errors are not there.
  Estimate pixel(int x, int y) const;
  /// The mean over the pixels.
  Estimate region(const Region& region) const;
  Estimate mean() const { return region({0, 0, width(), height()}); }
  /// Root mean square of the pixels' relative standard errors; infinite with fewer than two passes.
  double relative_error() const;

 private:
  friend struct details::Access;
  explicit Picture(std::shared_ptr<const details::PictureState> state);
  std::shared_ptr<const details::PictureState> state_;
};

}  // namespace kaustik::v0
