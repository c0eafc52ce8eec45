#pragma once
#include <string>
#include <vector>

#include "kaustik/image/image.h"

namespace kaustik {

/// Puts a picture together from images that are windows of it, whose frames tell where they lie.
/// Takes them one after the other, so that two pictures are in memory at most.
class Stitcher {
 public:
  /// `name` is for messages. Throws Error(input) if the part is of a picture of another size, has
  /// other channels, or another value where an earlier part has a pixel, too.
  void add(const std::string& name, const Image& part);
  /// The whole picture. Of the metadata, what all parts agree on; times are added,
  /// "incomplete" is kept of any part, and the place of the crop window is dropped. A channel keeps
  /// its floats if it does in any part. Throws Error(input) if a pixel is in no part.
  Image finish() &&;
  /// Metadata on which the parts do not agree.
  const std::vector<std::string>& differing() const { return differing_; }

 private:
  void begin(const std::string& name, const Image& part);
  void check(const std::string& name, const Image& part) const;
  void note_differing(const std::string& key);
  void take_metadata(const Image& part);

  Image whole_;
  std::string first_name_;
  std::vector<bool> known_;
  std::vector<std::string> differing_;
};

}  // namespace kaustik
