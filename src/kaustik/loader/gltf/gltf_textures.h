#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>

#include "kaustik/loader/gltf/gltf_file.h"

namespace kaustik::gltf {

/// What is taken of a picture.
enum class TextureUse {
  color,  ///< sRGB encoded
  data,   ///< red, green and blue as they are stored: normals
  red,    ///< one channel, as it is stored …
  green,
  blue,
  opacity,  ///< … or opacity
};

/// Makes textures of what materials refer to.
class Textures {
 public:
  Textures(File& file, Deviations& deviations) : file_(file), deviations_(deviations) {}

  /// Of a textureInfo, which has `index`. A picture that is not there is told; it becomes a magenta
  /// checker where it is a colour, else null.
  std::shared_ptr<Object> texture(const JsonValue& info, TextureUse use);
  /// Which TEXCOORD_… it takes.
  size_t uv_set(const JsonValue& info) const;

 private:
  /// Gives a bitmap its picture; why there is none otherwise, "" if it has one.
  std::string give_picture(Object& bitmap, const JsonValue& image, size_t index);
  std::string give_file(Object& bitmap, const std::string& uri, const JsonValue& image);
  std::optional<size_t> image_of(const JsonValue& texture) const;
  void give_sampler(Object& bitmap, const JsonValue& texture) const;
  void give_transform(Object& bitmap, const JsonValue& info) const;
  std::shared_ptr<Object> stand_in(const JsonValue& info, TextureUse use) const;

  File& file_;
  Deviations& deviations_;
  /// By the place of the textureInfo and the use.
  std::map<std::pair<const JsonValue*, TextureUse>, std::shared_ptr<Object>> known_;
  /// Bytes of pictures in the file, by image.
  std::map<size_t, std::shared_ptr<const Array>> pictures_;
};

}  // namespace kaustik::gltf
