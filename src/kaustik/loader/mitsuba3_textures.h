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
  /// The same of what a lamp's parameter `scale` multiplies its `radiance` by. A texture that has
  /// another name and that Kaustik takes for the radiance is called so.
  void use_radiance_of_lamp(Object& lamp);

  /// What the picture of a `bitmap` has to be multiplied by; 1 of those that stay as they are.
  Rgb factor_of(const Object& bitmap) const;

 private:
  /// Nothing: there is no such texture.
  using Scaled = std::variant<std::monostate, Rgb, std::shared_ptr<Object>>;

  Scaled scaled(const std::shared_ptr<Object>& texture, const Rgb& factor);
  Scaled scaled_anew(const std::shared_ptr<Object>& texture, const Rgb& factor);
  Scaled scaled_colours(const Object& texture, const Rgb& factor);
  bool replace(Object& holder, Child& texture, const Parameter* row, const Scaled& by);
  bool use_scale_of_bump(Object& bump);
  void name_radiance(Object& lamp, const TypeInfo& info);
  size_t size_of(const Object& texture);

  const TypeTables& types_;
  std::map<const Object*, Rgb> factors_;   ///< of bitmaps
  std::map<const Object*, size_t> sizes_;  ///< how many textures are in one, with itself
  /// By the texture and its factor. It also keeps alive what the other maps know.
  std::map<std::pair<std::shared_ptr<Object>, std::array<double, 3>>, Scaled> scaled_;
};

}  // namespace kaustik
