#pragma once
#include <fmt/format.h>

#include <cstddef>

#include "kaustik/base/error.h"

namespace kaustik::radiance {

/// What a scene may place: in proportion to its files that is the user's affair, but arrays and
/// files that are included again and again multiply, and get only `beyond_files` bytes more.
class PlacingBudget {
 public:
  static constexpr size_t beyond_files = size_t{512} << 20, per_byte = 32;

  void allow_file(size_t bytes) { allowed_ += per_byte * bytes; }
  /// Throws Error(input) if that is too much.
  void spend(size_t bytes, const Place& place) {
    if (bytes > allowed_ - spent_)
      throw Error(ErrorKind::input,
                  fmt::format("copies of objects take more than {} MiB beyond the scene's files",
                              beyond_files >> 20),
                  "make arrays smaller (xform -a), and include each file fewer times", place);
    spent_ += bytes;
  }

 private:
  size_t allowed_ = beyond_files, spent_ = 0;
};

}  // namespace kaustik::radiance
