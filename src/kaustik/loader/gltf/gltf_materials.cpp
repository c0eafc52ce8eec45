#include "kaustik/loader/gltf/gltf_materials.h"

#include "kaustik/loader/gltf/gltf_material_reader.h"

namespace kaustik::gltf {

Materials::Materials(File& file, const Options& options, Deviations& deviations)
    : file_(file),
      options_(options),
      deviations_(deviations),
      textures_(file, deviations),
      default_material_(JsonValue::Members(), 0) {}

const Surface& Materials::surface(std::optional<size_t> material, const SurfaceUse& use) {
  auto [entry, is_new] = known_.try_emplace({material, use});
  if (is_new) entry->second = make(material, use);
  return entry->second;
}

Surface Materials::make(std::optional<size_t> index, const SurfaceUse& use) {
  const JsonValue& material =
      index ? file_.item("materials", *index, file_.root()) : default_material_;
  const std::string name =
      index ? file_.name_of("material", material, *index) : "the default material";
  if (index && asks_if_closed(index) && use.is_closed)
    deviations_.approximated(
        name,
        "it lets light through and has no thickness; on closed meshes it is solid glass "
        "(gltf.glass=thin makes it panes)",
        file_.place(material));
  const std::vector<const JsonValue*> infos = texture_infos(material);
  for (const JsonValue* info : infos)
    if (textures_.uv_set(*info) != uv_set(index)) {
      deviations_.approximated(name, "all its textures take the same texture coordinates",
                               file_.place(*info));
      break;
    }
  Surface surface =
      MaterialReader(file_, textures_, options_, deviations_, material, name, use).read();
  const JsonValue* strength = file_.extension(material, "KHR_materials_emissive_strength");
  if (surface.emitter && strength && file_.number(*strength, "emissiveStrength", 1) > 1)
    has_bright_emission_ = true;
  return surface;
}

bool Materials::asks_if_closed(std::optional<size_t> index) const {
  if (!index || options_.glass != Glass::automatic) return false;
  const JsonValue& material = file_.item("materials", *index, file_.root());
  const JsonValue* transmission = file_.extension(material, "KHR_materials_transmission");
  if (!transmission || !(file_.number(*transmission, "transmissionFactor", 0) > 0)) return false;
  const JsonValue* volume = file_.extension(material, "KHR_materials_volume");
  return !volume || !(file_.number(*volume, "thicknessFactor", 0) > 0);
}

size_t Materials::uv_set(std::optional<size_t> index) const {
  if (!index) return 0;
  const auto infos = texture_infos(file_.item("materials", *index, file_.root()));
  return infos.empty() ? 0 : textures_.uv_set(*infos.front());
}

/// The base colour's first. The occlusion does not count: light finds its way itself.
std::vector<const JsonValue*> texture_infos(const JsonValue& material) {
  std::vector<const JsonValue*> result;
  const auto add = [&](const JsonValue* parent) {
    if (!parent) return;
    for (const auto& [name, value] : parent->members())
      if (name.ends_with("Texture") && name != "occlusionTexture" && value.find("index"))
        result.push_back(&value);
  };
  if (const JsonValue* base = material.find("pbrMetallicRoughness")) {
    if (const JsonValue* color = base->find("baseColorTexture")) result.push_back(color);
    if (const JsonValue* rest = base->find("metallicRoughnessTexture")) result.push_back(rest);
  }
  add(&material);
  if (const JsonValue* extensions = material.find("extensions"))
    for (const auto& extension : extensions->members()) add(&extension.second);

  return result;
}

}  // namespace kaustik::gltf
