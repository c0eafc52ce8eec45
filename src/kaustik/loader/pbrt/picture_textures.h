#pragma once
#include <memory>
#include <string>

#include "kaustik/base/transform.h"
#include "kaustik/loader/pbrt/described.h"
#include "kaustik/loader/pbrt/scene_files.h"

namespace kaustik::pbrt {

/// A picture as pbrt's textures name it.
struct PictureTexture {
  std::string file, filter = "bilinear", wrap = "repeat";
  std::string encoding;  ///< "": what is usual for the kind of file
  Transform mapping;     ///< of uv, before v is counted from the upper edge
  double power = 1;      ///< of the linear values
  bool is_raw = false;   ///< numbers are linear whatever the file
  /// One number: opacity where the picture has one, else the mean of its colours.
  bool is_number = false;
  bool is_inverted = false;  ///< 1 minus the linear values, before the power
};

/// A bitmap for it, or what stands for one that is missing.
std::shared_ptr<Object> make_bitmap(const PictureTexture& picture, SceneFiles& files,
                                    Deviations& deviations, const std::string& object,
                                    const Place& place);

/// Magenta and black squares.
std::shared_ptr<Object> missing_picture(const Place& place);

/// Whether Kaustik reads such a picture, by its name.
bool is_readable_picture(const std::string& file);

}  // namespace kaustik::pbrt
