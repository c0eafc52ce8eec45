#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// A value that a render has told, with half the width of its 95 % interval; NaN: not known.
struct ToldValue {
  std::optional<Vec3d> position;  ///< of a meter; none: it is the mean of the picture
  double value = 0, half_width = 0;
  std::string unit;
};

/// What `--progress-file` of a render has told.
struct RenderEvents {
  std::optional<int> exit_code;  ///< none: it was not told that it ended
  std::vector<ToldValue> values;
  int64_t passes = 0, samples_per_pixel = 0;
  double seconds = 0;
};

/// None: there is no such file. Lines that are no events do not count.
std::optional<RenderEvents> read_render_events(const std::string& path);

}  // namespace kaustik
