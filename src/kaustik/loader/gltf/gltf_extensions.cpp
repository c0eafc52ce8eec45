#include "kaustik/loader/gltf/gltf_extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace kaustik::gltf {
namespace {

/// Those whose meaning is rendered, or told where it is not.
constexpr std::string_view readable[] = {"KHR_draco_mesh_compression",
                                         "KHR_lights_punctual",
                                         "KHR_materials_anisotropy",
                                         "KHR_materials_clearcoat",
                                         "KHR_materials_diffuse_transmission",
                                         "KHR_materials_dispersion",
                                         "KHR_materials_emissive_strength",
                                         "KHR_materials_ior",
                                         "KHR_materials_iridescence",
                                         "KHR_materials_pbrSpecularGlossiness",
                                         "KHR_materials_sheen",
                                         "KHR_materials_specular",
                                         "KHR_materials_transmission",
                                         "KHR_materials_unlit",
                                         "KHR_materials_variants",
                                         "KHR_materials_volume",
                                         "KHR_mesh_quantization",
                                         "KHR_node_visibility",
                                         "KHR_texture_transform",
                                         "EXT_lights_ies",
                                         "EXT_mesh_gpu_instancing",
                                         "EXT_meshopt_compression",
                                         "KHR_meshopt_compression",
                                         "EXT_texture_webp"};
/// Those that add nothing to a picture.
constexpr std::string_view harmless[] = {"KHR_xmp", "KHR_xmp_json_ld", "KHR_animation_pointer"};
/// Those whose meaning is told where it is met.
constexpr std::string_view told_elsewhere[] = {"KHR_texture_basisu"};

template <size_t n>
bool is_in(const std::string_view (&names)[n], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

}  // namespace

void check_extensions(const File& file, Deviations& deviations) {
  for (const JsonValue& item : file.list("extensionsRequired")) {
    const std::string name = item.text() ? item.text()->substr(0, 100) : "";
    if (!is_in(readable, name) && !is_in(harmless, name) && !is_in(told_elsewhere, name))
      file.fail(item,
                fmt::format("the file requires the extension '{}', which cannot be read", name),
                "export it without that");
  }
  for (const JsonValue& item : file.list("extensionsUsed")) {
    const std::string name = item.text() ? item.text()->substr(0, 100) : "";
    if (!is_in(readable, name) && !is_in(harmless, name) && !is_in(told_elsewhere, name) &&
        !name.starts_with("KHR_materials_"))
      deviations.ignored(fmt::format("extension '{}'", name), "it is not read", file.place(item));
  }
}

}  // namespace kaustik::gltf
