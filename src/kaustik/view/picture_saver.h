#pragma once
#include <set>
#include <string>

#include "kaustik/image/image.h"

namespace kaustik::view {

/// Writes pictures into one folder, by names that clients give: plain names alone, of pictures, and
/// never in the place of what was there before. In one thread.
class PictureSaver {
 public:
  explicit PictureSaver(std::string folder) : folder_(std::move(folder)) {}

  /// The file of that name. Throws RequestError if it is none that may be written.
  std::string path_for(const std::string& name) const;
  /// Throws as path_for() and write_image() do.
  void save(const Image& image, const std::string& name);

 private:
  std::string folder_;
  std::set<std::string> saved_;  ///< which may be written again
};

}  // namespace kaustik::view
