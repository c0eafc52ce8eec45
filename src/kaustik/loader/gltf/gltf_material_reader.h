#pragma once
// One material of glTF; for Materials alone.

#include <memory>
#include <string>
#include <vector>

#include "kaustik/loader/gltf/gltf_materials.h"

namespace kaustik::gltf {

/// A number or a colour, and the texture that it is a factor on.
struct Textured {
  Rgb factor = {1, 1, 1};
  std::shared_ptr<Object> texture;  ///< null: none
};

/// Makes the surface of one material.
class MaterialReader {
 public:
  /// `name`: of the material, for messages.
  MaterialReader(const File& file, Textures& textures, const Options& options,
                 Deviations& deviations, const JsonValue& material, std::string name,
                 const SurfaceUse& use);

  Surface read();

 private:
  // The metallic-roughness model and its extensions, as parameters of `openpbr`.
  void read_base(Object& bsdf);
  void read_specular(Object& bsdf);
  void read_transmission(Object& bsdf);
  void read_clearcoat(Object& bsdf);
  void read_sheen(Object& bsdf);
  void read_anisotropy(Object& bsdf);
  void read_diffuse_transmission(Object& bsdf);
  void read_specular_glossiness(Object& bsdf, const JsonValue& extension);

  std::shared_ptr<Object> unlit();
  /// A bsdf of clear glass alone; null: the material is more than that.
  std::shared_ptr<Object> glass();
  bool has_layers() const;
  std::shared_ptr<Object> bent(std::shared_ptr<Object> bsdf);
  std::shared_ptr<Object> masked(std::shared_ptr<Object> bsdf);
  std::shared_ptr<Object> interior() const;
  std::shared_ptr<Object> emitter();
  void tell_of_others() const;

  bool transmits() const { return transmission_ > 0; }
  bool is_solid() const;
  bool is_thin() const { return transmits() && !is_solid(); }
  /// 1.5 unless KHR_materials_ior says otherwise.
  double ior() const;
  double normal_reflectance() const;

  // Values that may have textures.
  double unit(const JsonValue& object, const char* name, double usual) const;
  Textured scalar(const JsonValue& object, const char* factor, double usual, const char* texture,
                  TextureUse use);
  Textured color(const JsonValue& object, const char* factor, double usual, const char* texture);
  std::vector<double> color_factor() const;
  const JsonValue* color_texture() const;
  Textured base_color();
  Textured opacity();
  /// Gives a bsdf the value, as a property or as a texture.
  void give_value(Object& to, const char* name, const Textured& value, bool is_number) const;
  static void set_number(Object& bsdf, const char* name, double number);
  void approximated(std::string what) const;
  void ignored(std::string what) const;
  const JsonValue* extension(const char* name) const { return file_.extension(material_, name); }

  const File& file_;
  Textures& textures_;
  const Options& options_;
  Deviations& deviations_;
  const JsonValue& material_;
  std::string name_;
  SurfaceUse use_;
  Place place_;
  JsonValue nothing_{JsonValue::Members(), 0};
  const JsonValue* base_;        ///< pbrMetallicRoughness, or nothing
  const JsonValue* glossiness_;  ///< the archived model, where it takes the place of that; or null
  double transmission_ = 0;
};

/// "clearcoatTexture" and the like of a material, all that it has.
std::vector<const JsonValue*> texture_infos(const JsonValue& material);

}  // namespace kaustik::gltf
