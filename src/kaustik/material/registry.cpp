#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {

const std::vector<BsdfType>& bsdf_types() {
  static const std::vector<BsdfType> types = {diffuse_type(),
                                              roughdiffuse_type(),
                                              phong_type(),
                                              thinphong_type(),
                                              difftrans_type(),
                                              dielectric_type(),
                                              roughdielectric_type(),
                                              thindielectric_type(),
                                              conductor_type(),
                                              roughconductor_type(),
                                              plastic_type(),
                                              roughplastic_type(),
                                              principled_type(),
                                              twosided_type(),
                                              mask_type(),
                                              blendbsdf_type(),
                                              bumpmap_type(),
                                              normalmap_type(),
                                              null_type()};
  return types;
}

const std::vector<TextureType>& texture_types() {
  static const std::vector<TextureType> types = {
      bitmap_type(), checkerboard_type(), gridtexture_type(), scale_type(), mesh_attribute_type(),
      noise_type(),  marble_type(),       wood_type(),        tiles_type(), waves_type()};
  return types;
}

}  // namespace kaustik
