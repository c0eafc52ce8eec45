#pragma once
#include "kaustik/base/parameters.h"
#include "kaustik/image/image_io.h"

namespace kaustik {

/// Reads the pictures that a scene names, whole and only their colours, within one budget of
/// memory, and collects what is odd about them.
class PictureReader {
 public:
  /// `memory_bytes`: that all pictures may take together.
  explicit PictureReader(int64_t memory_bytes = default_picture_memory());

  /// The picture that argument `filename` names, of which the caller keeps so many bytes per pixel.
  /// All its colours are finite and at least 0, for others would poison every path that meets them:
  /// negative and undefined ones become 0, infinite ones the largest value that there is; a warning
  /// tells their number. Throws Error(input) at the place of the file name where it cannot be read
  /// or has no colours, Error(system) there where the budget is spent.
  Image read(const Arguments& arguments, int64_t kept_bytes_per_pixel, bool srgb_to_linear = true);

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  int64_t budget_bytes_, left_bytes_;
  std::vector<std::string> warnings_;
};

}  // namespace kaustik
