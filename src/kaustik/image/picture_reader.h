#pragma once
#include "kaustik/base/parameters.h"
#include "kaustik/image/image_io.h"

namespace kaustik {

/// The rows `filename` and `data`, which say what picture an object shows, and then the others;
/// `of_file` ends the sentence about the file.
std::vector<Parameter> picture_parameters(const std::string& of_file,
                                          std::vector<Parameter> others);
/// "picture 'sky.exr'", for messages, and where the picture was given.
std::string picture_name(const Arguments& arguments);
Place picture_place(const Arguments& arguments);

/// What an object takes of its picture.
struct PictureWish {
  /// How values become linear: 0: as the file says, 1: they are linear, −1: they are sRGB encoded,
  /// else as this power of them. Opacity is always linear.
  double gamma = 0;
  std::string channels = {};  ///< see picture_channels()
};

/// The row `gamma`, and what it says: see PictureWish::gamma. Throws Error(input) for what is no
/// power.
Parameter gamma_parameter();
double gamma_of(const Arguments& arguments);

/// Reads the pictures that a scene names, whole and only their colours, within one budget of
/// memory, and collects what is odd about them.
class PictureReader {
 public:
  /// `memory_bytes`: that all pictures may take together.
  explicit PictureReader(int64_t memory_bytes = default_picture_memory());

  /// The picture that argument `filename` names, or that is in the buffer `data`, as one that
  /// rgb_view() shows; the caller keeps so many bytes per pixel of it.
  /// All its colours are finite and at least 0, for others would poison every path that meets them:
  /// negative and undefined ones become 0, infinite ones the largest value that there is; a warning
  /// tells their number, another which layer was chosen where the picture has several. Throws
  /// Error(input) at the place of the name or buffer where it cannot be read or has no colours,
  /// at that of `channel` where it has none that is called so, Error(system) where the budget is
  /// spent.
  Image read(const Arguments& arguments, int64_t kept_bytes_per_pixel,
             const PictureWish& wish = {});

  const std::vector<std::string>& warnings() const { return warnings_; }
  /// How many pictures were read.
  int read_count() const { return read_count_; }

  /// What reading some pictures has cost, and what was odd about them.
  struct Use {
    int64_t bytes = 0;
    std::vector<std::string> warnings;
  };
  /// Of all that was read since the reader stood so.
  struct Mark {
    int64_t left_bytes;
    size_t warnings;
  };
  Mark mark() const { return {left_bytes_, warnings_.size()}; }
  Use use_since(const Mark& mark) const;
  /// Accounts for pictures that are kept from elsewhere as if they had been read; false, with
  /// nothing done, where the budget is too small for them.
  bool account(const Use& use);

 private:
  /// The channels that are wanted, called as a picture's own are.
  Image chosen(Image image, const Arguments& arguments, const PictureWish& wish);

  int64_t budget_bytes_, left_bytes_;
  int read_count_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace kaustik
