#include "kaustik/loader/radiance/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/radiance/lobes.h"
#include "kaustik/loader/radiance/material_builder.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

/// Of all patterns in space together: 12 bytes each.
constexpr size_t most_samples = 500'000, most_samples_of_one = 150'000;

/// mkillum writes the light that arrives at a window into tables of illum.cal: Kaustik computes it.
bool is_by_mkillum(const Look& look) {
  return std::any_of(look.patterns.begin(), look.patterns.end(), [](const Modifier* pattern) {
    const auto& strings = pattern->strings();
    return std::any_of(strings.begin(), strings.end(),
                       [](const std::string& word) { return word.ends_with("illum.cal"); });
  });
}

/// The modifier that an illum looks like; null: void.
const Modifier* alternate_of(const Modifier& illum) {
  if (illum.strings().empty()) return nullptr;
  const auto found = illum.named.find(illum.strings()[0]);
  return found == illum.named.end() ? nullptr : found->second.get();
}

}  // namespace

std::shared_ptr<const Appearance> MaterialMaker::appearance(
    const Modifier* modifier, bool is_mesh, const std::vector<PatternPoint>& samples) {
  auto& known = known_[{modifier, is_mesh}];
  if (!known) known = make(modifier, is_mesh, samples);
  return known;
}

std::optional<Rgb> MaterialMaker::radiance_of(const Modifier& material) {
  const std::string& type = material.type();
  if (type != "light" && type != "glow" && type != "illum" && type != "spotlight")
    return std::nullopt;
  if (material.reals().size() < 3) return std::nullopt;
  return Rgb{std::max(material.reals()[0], 0.0), std::max(material.reals()[1], 0.0),
             std::max(material.reals()[2], 0.0)};
}

std::shared_ptr<Appearance> MaterialMaker::make(const Modifier* modifier, bool is_mesh,
                                                const std::vector<PatternPoint>& samples) {
  auto made = std::make_shared<Appearance>();
  const Look look = look_of(modifier);
  for (const Modifier* texture : look.textures)
    if (texture->strings().empty() || texture->strings().back() != "corner_normals")
      deviations_.ignored(name_of(*texture->primitive),
                          "textures that bend normals are left out: the surface is smooth",
                          texture->place());
  if (look.mixture) return make_mixture(look, is_mesh, samples);
  if (!look.material) return made;
  const Modifier& material = *look.material;
  const bool is_illum = material.type() == "illum";
  if (is_illum) {
    const Modifier* alternate = alternate_of(material);
    if (alternate || is_by_mkillum(look)) {
      deviations_.approximated(name_of(*material.primitive),
                               "it does not shine, but looks like its alternate material: light "
                               "that comes through it is computed",
                               material.place());
      return alternate ? make(alternate, is_mesh, samples) : made;
    }
    deviations_.approximated(name_of(*material.primitive),
                             "it is a lamp that the camera does not see", material.place());
  }
  const bool shines = radiance_of(material).has_value();
  const Tint tint = tints_.tint_of(look.patterns, samples, is_mesh, !shines, shines);
  ObjectPointer texture;
  if (tint.picture) {
    texture = picture_texture(*tint.picture, tint.picture_modifier->place());
    made->picture = tint.picture;
  } else if (!tint.in_space.empty()) {
    made->grid = std::make_shared<PatternGrid>(tint.in_space, Rgb{1, 1, 1}, material.place());
    grids_.emplace_back(made->grid, look.patterns.front());
    texture = made->grid->texture();
  }
  std::optional<BsdfShares> measured;
  if (const size_t file = material.type() == "BSDF" ? 1 : 0;
      (file == 1 || material.type() == "aBSDF") && material.strings().size() > file)
    if (const auto text = patterns_.text_for(material.strings()[file], material))
      measured = read_bsdf_shares(*text);
  MaterialBuilder(material, tint, texture, measured, deviations_).build(*made);
  return made;
}

std::shared_ptr<Appearance> MaterialMaker::make_mixture(const Look& look, bool is_mesh,
                                                        const std::vector<PatternPoint>& samples) {
  const Modifier& mixture = *look.mixture;
  const std::string name = name_of(*mixture.primitive);
  auto made = std::make_shared<Appearance>();
  if (mixture.strings().size() < 3) {
    deviations_.ignored(name, "the mixture lacks strings: it is left out", mixture.place());
    return made;
  }
  const auto part = [&](size_t index) {
    const auto found = mixture.named.find(mixture.strings()[index]);
    const Modifier* modifier = found == mixture.named.end() ? nullptr : found->second.get();
    if (!modifier && mixture.strings()[index] != "void")
      deviations_.missing(name,
                          fmt::format("there is no modifier '{}': nothing stands for it",
                                      mixture.strings()[index].substr(0, 60)),
                          mixture.place());
    return modifier ? make(modifier, is_mesh, samples) : std::make_shared<Appearance>();
  };
  const auto fore = part(0), back = part(1);
  double weight = 0.5;
  ObjectPointer texture;
  if (const auto number = number_of(mixture.strings()[2]); mixture.type() == "mixfunc" && number) {
    weight = std::clamp(*number, 0.0, 1.0);
  } else if (mixture.type() == "mixtext") {
    deviations_.approximated(name, "its letters are left out", mixture.place());
    weight = 0;
  } else {
    const Tint tint =
        tints_.tint_of({&mixture}, samples, is_mesh && !fore->picture && !back->picture,
                       !fore->grid && !back->grid);
    if (tint.picture) {
      texture = picture_texture(*tint.picture, mixture.place());
      made->picture = tint.picture;
    } else if (!tint.in_space.empty()) {
      made->grid = std::make_shared<PatternGrid>(tint.in_space, Rgb{1, 1, 1}, mixture.place());
      grids_.emplace_back(made->grid, &mixture);
      texture = made->grid->texture();
    } else {
      weight = std::clamp(tint.factor.g, 0.0, 1.0);
    }
  }
  const auto put_share = [&](Object& object, const char* parameter, double share) {
    if (texture)
      nest(object, texture, parameter);
    else
      give(object, parameter, share);
  };
  for (const auto& appearance : {fore, back}) {
    if (!made->picture) made->picture = appearance->picture;
    if (!made->grid) made->grid = appearance->grid;
    if (!made->interior) made->interior = appearance->interior;
    if (!made->tangent) made->tangent = appearance->tangent;
    if (appearance->emitter || appearance->beam)
      deviations_.ignored(name, "the light of what it mixes is left out", mixture.place());
  }
  const auto null_bsdf = [&] { return make_object("bsdf", "null", mixture.place()); };
  if (!fore->bsdf && !back->bsdf) return made;
  if (fore->bsdf && !back->bsdf) {
    made->bsdf = make_object("bsdf", "mask", mixture.place());
    put_share(*made->bsdf, "opacity", weight);
    nest(*made->bsdf, fore->bsdf);
    return made;
  }
  made->bsdf = make_object("bsdf", "blendbsdf", mixture.place());
  put_share(*made->bsdf, "weight", weight);
  nest(*made->bsdf, back->bsdf);
  nest(*made->bsdf, fore->bsdf ? fore->bsdf : null_bsdf());
  return made;
}

void MaterialMaker::finish() {
  size_t left = most_samples;
  for (const auto& [grid, pattern] : grids_) {
    const size_t samples = std::min(left / 2 + 1000, most_samples_of_one);
    left -= std::min(left, samples);
    const bool is_whole = grid->fill(samples);
    deviations_.approximated(
        name_of(*pattern->primitive),
        fmt::format("the pattern is sampled every {:.3g} units of length{}", grid->spacing(),
                    is_whole ? "" : ", and is black where its function has no value"),
        pattern->place());
  }
  grids_.clear();
}

}  // namespace kaustik::radiance
