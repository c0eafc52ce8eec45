#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/base/array.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Numbers over a box, as files and programs give them.
struct VolumeSamples {
  std::array<int, 3> size{0, 0, 0};  ///< along x, y and z, at least 1
  int channels = 1;                  ///< of each place: 1, 3 or 6
  /// x runs fastest, then y, then z; the channels of a place lie together. Finite.
  std::vector<float> values;
  std::optional<Bounds3f> box;  ///< that the file places them in, m; a buffer has none
};

/// A file of Mitsuba's format VOL, version 3, of floats or (0.6) bytes that stand for 0 to 1.
/// Whatever is wrong with it is an Error(input) with the file as its place; memory is taken in
/// proportion to what the file holds.
VolumeSamples read_vol(const std::string& path);

/// Of a buffer [z, y, x] or [z, y, x, channels]; bytes and 16-bit integers stand for 0 to 1. Throws
/// Error(input) without a place.
VolumeSamples samples_of_array(const Array& array);

}  // namespace kaustik
