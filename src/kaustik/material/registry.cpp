#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {

const std::vector<BsdfType>& bsdf_types() {
  static const std::vector<BsdfType> types = {
      diffuse_type(),        roughdiffuse_type(), phong_type(),          thinphong_type(),
      ward_type(),           difftrans_type(),    dielectric_type(),     roughdielectric_type(),
      thindielectric_type(), conductor_type(),    roughconductor_type(), plastic_type(),
      roughplastic_type(),   pplastic_type(),     principled_type(),     principledthin_type(),
      openpbr_type(),        twosided_type(),     mask_type(),           blendbsdf_type(),
      mixturebsdf_type(),    coating_type(),      roughcoating_type(),   bumpmap_type(),
      normalmap_type(),      null_type()};
  return types;
}

std::string_view remedy_for_bsdf_to_come(std::string_view type) {
  struct Row {
    std::string_view type, remedy;
  };
  static constexpr Row rows[] = {
      {"hair", "use 'principled' or 'roughplastic'"},
      {"measured", "use 'principled' or 'roughconductor' with a like colour"},
      {"measured_polarized", "light is not polarised; use 'principled' with a like colour"},
      {"bsdfdata", "use 'thinphong' with its mean reflectance and transmittance"},
      {"polarizer",
       "light is not polarised; 'mask' of opacity 0.5 around a black 'diffuse' does that"},
      {"retarder", "light is not polarised; 'null' does that"},
      {"circular",
       "light is not polarised; 'mask' of opacity 0.5 around a black 'diffuse' does that"},
      {"hk", "use 'difftrans' or 'thinphong' with a like colour"},
      {"irawan", "use 'principled' with sheen"}};
  for (const Row& row : rows)
    if (row.type == type) return row.remedy;
  return {};
}

const std::vector<TextureType>& texture_types() {
  static const std::vector<TextureType> types = {
      bitmap_type(),         checkerboard_type(),   gridtexture_type(), scale_type(),
      mesh_attribute_type(), volume_texture_type(), noise_type(),       marble_type(),
      wood_type(),           tiles_type(),          waves_type()};
  return types;
}

}  // namespace kaustik
