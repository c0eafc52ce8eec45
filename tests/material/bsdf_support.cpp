#include "tests/material/bsdf_support.h"

#include <algorithm>
#include <stdexcept>
#include <typeinfo>

#include "kaustik/base/error.h"
#include "kaustik/image/picture_reader.h"

namespace kaustik::test {

Property property(const std::string& name, Value value) { return {name, std::move(value), {}}; }

std::shared_ptr<const Bsdf> make_bsdf(
    const std::string& type, const std::vector<Property>& properties,
    std::vector<std::shared_ptr<const Bsdf>> nested,
    std::map<std::string, std::shared_ptr<const Texture>> textures,
    const std::function<void(const std::string&)>& warn) {
  for (const BsdfType& t : bsdf_types()) {
    if (t.info.name != type) continue;
    Problems problems;
    const Arguments arguments(t.info, properties, place_in("scene.xml", 3, 5), problems);
    problems.throw_if_any();
    const auto texture = [&](std::string_view name) {
      const auto found = textures.find(std::string(name));
      return found != textures.end() ? found->second : constant_texture_of(arguments, name);
    };
    return t.create({arguments, std::move(nested), texture, warn});
  }
  throw std::invalid_argument("no bsdf type " + type);
}

std::shared_ptr<const Bsdf> make_usual_bsdf(const BsdfType& type) {
  const std::vector nested(size_t(type.minimum_nested), make_bsdf("diffuse"));
  try {
    return make_bsdf(type.info.name, {}, nested);
  } catch (const Error&) {
    // It asks for a texture.
    std::map<std::string, std::shared_ptr<const Texture>> textures;
    for (const Parameter& parameter : type.info.parameters)
      if (parameter.accepts_texture) textures[parameter.name] = make_texture("checkerboard");
    return make_bsdf(type.info.name, {}, nested, std::move(textures));
  }
}

std::shared_ptr<const Texture> make_texture(
    const std::string& type, std::vector<Property> properties,
    std::map<std::string, std::shared_ptr<const Texture>> textures,
    std::map<std::string, std::shared_ptr<const Volume>> volumes) {
  for (const TextureType& t : texture_types()) {
    if (t.info.name != type) continue;
    for (Property& p : properties) p.place = place_in("scene.xml", 9, 4);
    Problems problems;
    const Arguments arguments(t.info, properties, place_in("scene.xml", 8, 2), problems);
    problems.throw_if_any();
    PictureReader pictures;
    const auto texture = [&](std::string_view name) {
      const auto found = textures.find(std::string(name));
      return found != textures.end() ? found->second : constant_texture_of(arguments, name);
    };
    const auto attribute = [&](const std::string& name) -> std::shared_ptr<const SurfaceAttribute> {
      if (name != "vertex_color") throw Error(ErrorKind::input, "no attribute " + name, "", {});
      return std::make_shared<SlantedAttribute>();
    };
    const auto volume = [&](std::string_view name) -> std::shared_ptr<const Volume> {
      const auto found = volumes.find(std::string(name));
      return found != volumes.end() ? found->second : nullptr;
    };
    return t.create({arguments, pictures, texture, attribute, volume});
  }
  throw std::invalid_argument("no texture type " + type);
}

std::shared_ptr<const Volume> repeated_volume() {
  VolumeSamples samples;
  samples.size = {3, 2, 2};
  samples.channels = 3;
  for (int i = 0; i < 36; ++i) samples.values.push_back(float(i * 7 % 36) / 36);
  return std::make_shared<Volume>(GridVolume(samples, GridVolume::Filter::trilinear,
                                             GridVolume::Wrap::repeat,
                                             Transform::scale({4, 4, 4})));
}

std::shared_ptr<const Texture> make_usual_texture(const TextureType& type,
                                                  const std::string& picture,
                                                  std::vector<Property> properties) {
  if (type.info.find("filename")) properties.push_back(property("filename", picture));
  if (type.info.find("name")) properties.push_back(property("name", std::string("vertex_color")));
  if (type.info.find("value")) properties.push_back(property("value", 0.5));
  std::map<std::string, std::shared_ptr<const Volume>> volumes;
  for (const Parameter& parameter : type.info.parameters)
    if (parameter.accepts_volume) volumes[parameter.name] = repeated_volume();
  return make_texture(type.info.name, std::move(properties), {}, std::move(volumes));
}

namespace {

std::shared_ptr<const Bsdf> rough(const std::string& distribution, double alpha) {
  return make_bsdf("roughconductor", {property("distribution", distribution),
                                      property("alpha", alpha), property("material", "cu")});
}

std::shared_ptr<const Bsdf> anisotropic(const std::string& distribution) {
  return make_bsdf("roughconductor",
                   {property("distribution", distribution), property("alpha_u", 0.1),
                    property("alpha_v", 0.4), property("specular_reflectance", 0.9)});
}

std::shared_ptr<const Bsdf> ground_glass(const std::string& distribution, double alpha,
                                         std::vector<Property> others = {}) {
  others.push_back(property("distribution", distribution));
  others.push_back(property("alpha", alpha));
  return make_bsdf("roughdielectric", others);
}

std::shared_ptr<const Bsdf> plastic(const Rgb& base, bool nonlinear) {
  return make_bsdf("plastic", {property("diffuse_reflectance", base),
                               property("nonlinear", nonlinear), property("int_ior", 1.9)});
}

std::shared_ptr<const Bsdf> rough_plastic(const std::string& distribution, double alpha) {
  return make_bsdf("roughplastic", {property("diffuse_reflectance", Rgb{0.8, 0.4, 0.1}),
                                    property("nonlinear", true), property("alpha", alpha),
                                    property("distribution", distribution)});
}

std::shared_ptr<const Bsdf> phong(const Rgb& diffuse, const Rgb& specular, double exponent) {
  return make_bsdf("phong",
                   {property("diffuse_reflectance", diffuse),
                    property("specular_reflectance", specular), property("exponent", exponent)});
}

std::shared_ptr<const Bsdf> sheet(double diffuse, double glossy, double diffuse_through,
                                  double glossy_through, double exponent) {
  return make_bsdf(
      "thinphong",
      {property("diffuse_reflectance", diffuse), property("specular_reflectance", glossy),
       property("diffuse_transmittance", diffuse_through),
       property("specular_transmittance", glossy_through), property("exponent", exponent)});
}

std::shared_ptr<const Bsdf> ward(const std::string& variant, double alpha_u, double alpha_v) {
  return make_bsdf(
      "ward", {property("variant", variant), property("alpha_u", alpha_u),
               property("alpha_v", alpha_v), property("diffuse_reflectance", Rgb{0.3, 0.1, 0.2}),
               property("specular_reflectance", Rgb{0.7, 0.4, 0.1})});
}

std::shared_ptr<const Bsdf> metal_of_colours(double alpha) {
  return make_bsdf("roughconductor", {property("distribution", "ggx"), property("alpha", alpha),
                                      property("reflectance", Rgb{0.9, 0.6, 0.2}),
                                      property("edge_tint", Rgb{0.2, 0.9, 0.5})});
}

/// A checkerboard that is `at_origin` where the tests look.
std::shared_ptr<const Texture> checks(double at_origin, double beside) {
  return make_texture("checkerboard", {property("color0", at_origin), property("color1", beside)});
}

std::vector<BsdfInstance> make_instances() {
  const auto coloured_phong = phong({0.5, 0.1, 0.2}, {0.2, 0.7, 0.3}, 30);
  return {
      {"diffuse", make_bsdf("diffuse")},
      {"diffuse_coloured", make_bsdf("diffuse", {property("reflectance", Rgb{0.9, 0.0, 0.3})})},
      {"roughdiffuse", make_bsdf("roughdiffuse", {property("reflectance", Rgb{1, 0.3, 0.6}),
                                                  property("roughness", 0.4)})},
      {"roughdiffuse_as_rough_as_can_be", make_bsdf("roughdiffuse", {property("reflectance", 1.0)},
                                                    {}, {{"roughness", checks(1, 0)}})},
      {"phong_coloured_30", coloured_phong},
      {"phong_3", phong({0.2, 0.2, 0.2}, {0.6, 0.6, 0.6}, 3)},
      {"phong_specular_1000", phong({0, 0, 0}, {1, 1, 1}, 1000)},
      {"phong_diffuse", phong({0.5, 0.5, 0.5}, {0, 0, 0}, 30)},
      {"beckmann_0.05", rough("beckmann", 0.05)},
      {"beckmann_0.3", rough("beckmann", 0.3)},
      {"beckmann_0.8", rough("beckmann", 0.8)},
      {"beckmann_anisotropic", anisotropic("beckmann")},
      {"ggx_0.05", rough("ggx", 0.05)},
      {"ggx_0.3", rough("ggx", 0.3)},
      {"ggx_0.8", rough("ggx", 0.8)},
      {"ggx_anisotropic", anisotropic("ggx")},
      {"twosided_diffuse", make_bsdf("twosided", {}, {make_bsdf("diffuse")})},
      {"twosided_two", make_bsdf("twosided", {}, {coloured_phong, rough("ggx", 0.3)})},
      {"sheet_all_lobes", sheet(0.2, 0.15, 0.3, 0.25, 20)},
      {"sheet_paper", sheet(0.5, 0, 0.4, 0, 30)},
      {"difftrans", make_bsdf("difftrans", {property("transmittance", Rgb{0.9, 0.5, 0.1})})},
      {"textured_phong", make_bsdf("phong", {}, {},
                                   {{"diffuse_reflectance", checks(0.6, 0.1)},
                                    {"specular_reflectance", checks(0.3, 0.9)},
                                    {"exponent", checks(12, 400)}})},
      {"textured_ggx",
       make_bsdf("roughconductor", {property("distribution", "ggx"), property("material", "cu")},
                 {}, {{"alpha", checks(0.25, 0.02)}, {"specular_reflectance", checks(0.8, 0.1)}})},
      {"mask_half", make_bsdf("mask", {}, {make_bsdf("twosided", {}, {coloured_phong})})},
      {"mask_textured", make_bsdf("mask", {}, {rough("ggx", 0.3)}, {{"opacity", checks(0.8, 0)}})},
      {"blend_phong_ggx",
       make_bsdf("blendbsdf", {property("weight", 0.3)}, {coloured_phong, rough("ggx", 0.3)})},
      {"blend_paper_glass",
       make_bsdf("blendbsdf", {}, {sheet(0.25, 0.3, 0.1, 0.3, 20), make_bsdf("dielectric")},
                 {{"weight", checks(0.2, 1)}})},
      {"mirror", make_bsdf("conductor")},
      {"gold", make_bsdf("conductor", {property("material", "Au")})},
      {"glass", make_bsdf("dielectric", {property("int_ior", 1.5), property("ext_ior", 1.0)})},
      {"tinted_water_bubble",
       make_bsdf("dielectric", {property("int_ior", "air"), property("ext_ior", "water"),
                                property("specular_reflectance", Rgb{1, 0.5, 0.9}),
                                property("specular_transmittance", Rgb{0.2, 0.9, 1})})},
      {"ground_glass_beckmann_0.05", ground_glass("beckmann", 0.05)},
      {"ground_glass_beckmann_0.3", ground_glass("beckmann", 0.3)},
      {"ground_glass_ggx_0.3", ground_glass("ggx", 0.3)},
      {"ground_glass_ggx_1", ground_glass("ggx", 1)},
      {"ground_air_bubble_tinted",
       ground_glass("ggx", 0.2,
                    {property("int_ior", "air"), property("ext_ior", 1.6),
                     property("specular_reflectance", Rgb{0.3, 1, 0.9}),
                     property("specular_transmittance", Rgb{0.2, 0.9, 1})})},
      {"brushed_glass",
       make_bsdf("roughdielectric", {property("distribution", "ggx"), property("alpha_u", 0.1),
                                     property("alpha_v", 0.5), property("int_ior", "diamond")})},
      {"textured_ground_glass",
       make_bsdf("roughdielectric", {property("int_ior", "water")}, {},
                 {{"alpha", checks(0.2, 0.02)}, {"specular_transmittance", checks(0.7, 0.1)}})},
      {"pane", make_bsdf("thindielectric", {property("specular_transmittance", Rgb{0.4, 0.9, 1})})},
      {"soap_film", make_bsdf("thindielectric", {property("int_ior", std::string("water")),
                                                 property("thickness", 350.0)})},
      {"plastic", plastic({0.5, 0.5, 0.5}, false)},
      {"plastic_nonlinear", plastic({0.9, 0.2, 0.6}, true)},
      {"rough_plastic_beckmann_0.05", rough_plastic("beckmann", 0.05)},
      {"rough_plastic_ggx_0.3", rough_plastic("ggx", 0.3)},
      {"rough_plastic_ggx_1", rough_plastic("ggx", 1)},
      {"principled_leather",
       make_bsdf("principled", {property("base_color", Rgb{0.5, 0.2, 0.1}),
                                property("roughness", 0.6), property("specular", 0.7)})},
      {"principled_velvet",
       make_bsdf("principled",
                 {property("base_color", Rgb{0.1, 0.3, 0.2}), property("roughness", 0.9),
                  property("sheen", 0.8), property("sheen_tint", 0.7), property("flatness", 0.5)})},
      {"principled_brushed_gold",
       make_bsdf("principled", {property("base_color", Rgb{0.9, 0.7, 0.3}),
                                property("metallic", 0.9), property("roughness", 0.5),
                                property("anisotropic", 0.8), property("spec_tint", 0.5)})},
      {"principled_glass",
       make_bsdf("principled", {property("base_color", Rgb{0.9, 0.8, 0.6}), property("eta", 1.5),
                                property("spec_trans", 0.8), property("roughness", 0.4)})},
      {"principled_varnish",
       make_bsdf("principled",
                 {property("base_color", Rgb{0.2, 0.1, 0.6}), property("roughness", 0.7),
                  property("clearcoat", 1.0), property("clearcoat_gloss", 0.2)})},
      {"principled_white_all_at_once",
       make_bsdf("principled", {property("base_color", 1.0), property("roughness", 1.0),
                                property("sheen", 1.0), property("clearcoat", 1.0)})},
      {"principled_textured", make_bsdf("principled", {property("sheen", 1.0)}, {},
                                        {{"base_color", checks(1, 0.1)},
                                         {"roughness", checks(0.5, 0.1)},
                                         {"metallic", checks(0.2, 1)},
                                         {"spec_trans", checks(0.3, 0)}})},
      {"principled_air_bubble",
       make_bsdf("principled", {property("base_color", Rgb{0.9, 0.8, 0.6}), property("eta", 0.7),
                                property("spec_trans", 0.8), property("spec_tint", 0.3),
                                property("clearcoat", 0.5), property("roughness", 0.4)})},
      {"thin_leaf",
       make_bsdf("principledthin",
                 {property("base_color", Rgb{0.3, 0.7, 0.1}), property("roughness", 0.6),
                  property("diff_trans", 1.2), property("sheen", 0.6), property("flatness", 0.5)})},
      {"thin_frosted_pane",
       make_bsdf("principledthin",
                 {property("base_color", Rgb{0.9, 0.6, 0.8}), property("roughness", 0.5),
                  property("spec_trans", 0.8), property("eta", 1.4), property("diff_trans", 0.6),
                  property("spec_tint", 0.5), property("anisotropic", 0.6)})},
      {"ward_balanced", ward("balanced", 0.15, 0.4)},
      {"ward_duer", ward("ward-duer", 0.3, 0.3)},
      {"ward_duer_anisotropic", ward("ward-duer", 0.5, 0.2)},
      {"ward_original", ward("ward", 0.3, 0.3)},
      {"ward_original_anisotropic", ward("ward", 0.15, 0.4)},
      {"ward_textured",
       make_bsdf("ward", {property("variant", std::string("ward")), property("alpha_v", 0.2)}, {},
                 {{"alpha_u", checks(0.4, 0.1)},
                  {"diffuse_reflectance", checks(0.3, 0.1)},
                  {"specular_reflectance", checks(0.6, 0.1)}})},
      {"mirror_of_colour", make_bsdf("conductor", {property("reflectance", Rgb{0.9, 0.6, 0.2})})},
      {"rough_metal_of_colours", metal_of_colours(0.3)},
      {"rough_metal_of_textures",
       make_bsdf("roughconductor", {property("alpha", 0.2), property("edge_tint", 0.5)}, {},
                 {{"reflectance", checks(0.7, 0.1)}})},
      {"mixture_of_three",
       make_bsdf("mixturebsdf", {property("weights", "0.3 0.2, 0.4")},
                 {make_bsdf("diffuse", {property("reflectance", Rgb{0.9, 0.2, 0.4})}),
                  metal_of_colours(0.4), sheet(0.2, 0.15, 0.3, 0.25, 20)})},
      {"coating_over_colour",
       make_bsdf("coating", {property("sigma_a", Rgb{0.1, 0.5, 0.9}), property("thickness", 0.3)},
                 {make_bsdf("diffuse", {property("reflectance", Rgb{0.9, 0.7, 0.3})})})},
      {"coating_over_copper_and_phong",
       make_bsdf("coating", {property("int_ior", 1.3)},
                 {make_bsdf("blendbsdf", {},
                            {rough("ggx", 0.3), phong({0.5, 0.1, 0.2}, {0, 0, 0}, 1)})})},
      {"rough_coating_over_gold",
       make_bsdf("roughcoating", {property("alpha", 0.3), property("distribution", "ggx")},
                 {make_bsdf("conductor", {property("material", "Au")})})},
      // Rough, since sharp ones take long to integrate.
      {"openpbr_plaster_skin_and_fuzz",
       make_bsdf("openpbr",
                 {property("base_color", Rgb{0.9, 0.4, 0.1}),
                  property("base_diffuse_roughness", 0.8), property("subsurface_weight", 0.4),
                  property("specular_weight", 0.5), property("specular_roughness", 0.7),
                  property("specular_color", Rgb{1, 0.5, 1}), property("fuzz_weight", 0.6)})},
      {"openpbr_car_paint",
       make_bsdf("openpbr",
                 {property("base_color", Rgb{0.8, 0.3, 0.1}), property("base_metalness", 0.7),
                  property("specular_roughness", 0.6), property("specular_color", Rgb{0.9, 0.5, 1}),
                  property("specular_roughness_anisotropy", 0.5), property("coat_weight", 0.8),
                  property("coat_roughness", 0.6), property("coat_color", Rgb{1, 0.7, 0.5})})},
      {"openpbr_coated_glass",
       make_bsdf("openpbr",
                 {property("transmission_weight", 0.8), property("coat_weight", 0.5),
                  property("transmission_color", Rgb{0.9, 1, 0.6}), property("coat_roughness", 0.6),
                  property("specular_roughness", 0.6), property("base_metalness", 0.1)})},
      {"openpbr_sheet",
       make_bsdf("openpbr",
                 {property("geometry_thin_walled", true), property("subsurface_weight", 0.7),
                  property("subsurface_color", Rgb{0.4, 0.9, 0.2}), property("fuzz_weight", 0.3),
                  property("subsurface_scatter_anisotropy", 0.3),
                  property("transmission_weight", 0.5), property("specular_roughness", 0.6),
                  property("transmission_color", Rgb{1, 0.6, 0.9})})},
      {"openpbr_textured", make_bsdf("openpbr", {property("specular_roughness", 0.6)}, {},
                                     {{"base_color", checks(0.8, 0.1)},
                                      {"base_metalness", checks(0.2, 1)},
                                      {"specular_weight", checks(0.7, 1)},
                                      {"transmission_weight", checks(0.3, 0)},
                                      {"geometry_opacity", checks(0.9, 0)}})},
      // Tables of albedos are those of one roughness: textured layers are farther off.
      {"openpbr_textured_coat",
       make_bsdf("openpbr",
                 {property("base_color", Rgb{0.9, 0.4, 0.1}), property("specular_roughness", 0.6)},
                 {},
                 {{"coat_weight", checks(0.8, 0)},
                  {"coat_roughness", checks(0.6, 0.1)},
                  {"coat_roughness_anisotropy", checks(0.5, 0)},
                  {"coat_color", checks(0.7, 0.1)},
                  {"coat_darkening", checks(0.4, 1)}}),
       0.1},
      {"openpbr_textured_fuzz",
       make_bsdf("openpbr",
                 {property("base_color", Rgb{0.9, 0.4, 0.1}), property("coat_weight", 0.5),
                  property("coat_roughness", 0.6), property("specular_roughness", 0.6)},
                 {},
                 {{"fuzz_weight", checks(0.7, 0)},
                  {"fuzz_roughness", checks(0.4, 0.9)},
                  {"fuzz_color", checks(0.9, 0.2)},
                  {"subsurface_weight", checks(0.5, 1)}}),
       0.1},
  };
}

bool has_like(const std::vector<BsdfInstance>& instances, const Bsdf& bsdf) {
  return std::any_of(instances.begin(), instances.end(), [&](const BsdfInstance& instance) {
    const Bsdf& other = *instance.bsdf;
    return typeid(other) == typeid(bsdf);
  });
}

Vec3f direction(double degrees, double azimuth_degrees) {
  const double theta = degrees * std::numbers::pi / 180;
  const double phi = azimuth_degrees * std::numbers::pi / 180;
  return normalize(Vec3f(float(std::sin(theta) * std::cos(phi)),
                         float(std::sin(theta) * std::sin(phi)), float(std::cos(theta))));
}

}  // namespace

const std::vector<BsdfInstance>& bsdf_instances() {
  static const std::vector<BsdfInstance> instances = [] {
    std::vector<BsdfInstance> all = make_instances();
    for (const BsdfType& type : bsdf_types()) {
      const auto usual = make_usual_bsdf(type);
      if (usual->traits().lobes != Lobes::none && !has_like(all, *usual))
        all.push_back({type.info.name, usual});
    }
    return all;
  }();
  return instances;
}

const std::vector<Vec3f>& outgoing_directions() {
  static const std::vector<Vec3f> directions = {direction(0, 0), direction(35, 20),
                                                direction(70, 140), direction(87, 250)};
  return directions;
}

std::vector<Lobes> lobe_sets(const Bsdf& bsdf) {
  std::vector<Lobes> sets = {Lobes::all};
  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy, Lobes::delta})
    if (any(bsdf.traits().lobes & lobe) && bsdf.traits().lobes != lobe) sets.push_back(lobe);
  return sets;
}

}  // namespace kaustik::test
