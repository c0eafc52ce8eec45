#pragma once
#include <cstddef>

#include "kaustik/base/error.h"

namespace kaustik::mitsuba {

/// What a scene may take while it is read. In proportion to its files that is the user's affair;
/// but a file that is included, or a curve that is named, again and again multiplies, and may take
/// only `beyond_files` more than that.
class LoadBudget {
 public:
  static constexpr size_t beyond_files = size_t{256} << 20;
  /// Memory per byte of XML: the shortest elements, such as <ref id="a"/>, make the most of theirs.
  static constexpr size_t per_byte = 64;

  /// For a file that is read for the first time.
  void allow_file(size_t bytes) { allow(per_byte * bytes); }
  void allow(size_t bytes) { allowed_ += bytes; }
  /// Throws Error(input) if that is too much.
  void spend(size_t bytes, const Place& place);

 private:
  size_t allowed_ = beyond_files, spent_ = 0;
};

}  // namespace kaustik::mitsuba
