#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "kaustik/base/type_tables.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// Does without textures of type `scale`: the factor goes into colours, into the heights' own
/// factor of a bump map, and into pictures, which then have to be written anew.
class TextureScaling {
 public:
  /// `types` must outlive this.
  explicit TextureScaling(const TypeTables& types) : types_(types) {}

  /// Puts those in `holder` in other terms, where there are such.
  void apply_to(Object& holder);
  /// The same of what a lamp's parameter `scale` multiplies its `radiance` by.
  void use_scale_of_lamp(Object& lamp);

  /// What the picture of a `bitmap` has to be multiplied by; 1 of those that stay as they are.
  Rgb factor_of(const Object& bitmap) const;

 private:
  /// Nothing: there is no such texture.
  using Scaled = std::variant<std::monostate, Value, std::shared_ptr<Object>>;

  Scaled scaled(const std::shared_ptr<Object>& texture, const Rgb& factor);
  Scaled scaled_colours(const Object& texture, const Rgb& factor);
  bool replace(Object& holder, const std::string& name, const Scaled& by);
  bool use_scale_of_bump(Object& bump);

  const TypeTables& types_;
  std::map<const Object*, Rgb> factors_;  ///< of bitmaps
  std::map<std::pair<const Object*, std::array<double, 3>>, std::shared_ptr<Object>> bitmaps_;
};

}  // namespace kaustik
