// The part of SceneBuilder for textures in shapes: heights of a height field.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kaustik/geometry/shape.h"
#include "kaustik/scene/scene_builder.h"
#include "kaustik/scene/spectrum_types.h"

namespace kaustik {
namespace {

constexpr int64_t usual_size = 256, least_size = 2, largest_size = 8192;

/// How many heights along an axis: what the shape says, else what the texture's picture has. Of
/// what is out of its range, which is told elsewhere, as few as there can be.
size_t size_along(const Object& shape, const char* name, int of_picture) {
  int64_t size =
      std::clamp<int64_t>(of_picture > 0 ? of_picture : usual_size, least_size, largest_size);
  for (const Property& property : shape.properties)
    if (const auto* given = std::get_if<int64_t>(&property.value); given && property.name == name)
      size = *given >= least_size && *given <= largest_size ? *given : least_size;
  return size_t(size);
}

/// Luminances in the middles of so many equal parts of the uv square. Textures in space lie on the
/// field's own square, at z = 0.
std::shared_ptr<const Array> heights_of(const Texture& texture, size_t columns, size_t rows) {
  std::vector<float> heights;
  heights.reserve(columns * rows);
  TextureCoordinates at;
  at.normal = {0, 0, 1};
  for (size_t y = 0; y < rows; ++y)
    for (size_t x = 0; x < columns; ++x) {
      at.uv = {(float(x) + 0.5f) / float(columns), (float(y) + 0.5f) / float(rows)};
      at.position = {2 * at.uv.x - 1, 2 * at.uv.y - 1, 0};
      heights.push_back(texture.scalar(at));
    }
  return Array::of<float>({rows, columns}, std::move(heights));
}

}  // namespace

bool SceneBuilder::takes_heights(const TypeInfo& shape) {
  return std::any_of(shape.parameters.begin(), shape.parameters.end(),
                     [](const Parameter& row) { return row.accepts_texture; });
}

std::optional<Object> SceneBuilder::with_heights(const Object& shape, const TypeInfo& info) {
  Object result = shape;
  bool is_first = true;
  for (const Child& child : shape.children) {
    if (child.object->family != "texture" || spectrum_type_of(*child.object)) continue;
    if (!takes_heights(info)) {
      // Mitsuba keeps them for integrators that ask for them.
      if (remarks_reported_.insert("textures of shapes").second)
        warnings_.push_back(fmt::format("{}: a texture in shape '{}' has no effect",
                                        text_of(child.object->place), shape.type));
      continue;
    }
    if (!std::exchange(is_first, false)) {
      problems_.add(fmt::format("shape '{}' has a second texture", shape.type), "keep one",
                    child.object->place);
      return std::nullopt;
    }
    const std::shared_ptr<const Texture> texture =
        make_texture(texture_within(child.object), nullptr);
    if (!texture) return std::nullopt;
    const Vec2i size = texture->resolution();
    result.properties.push_back({"heights",
                                 heights_of(*texture, size_along(shape, "width", size.x),
                                            size_along(shape, "height", size.y)),
                                 child.object->place});
  }
  return result;
}

}  // namespace kaustik
