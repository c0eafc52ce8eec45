#include "kaustik/loader/radiance/lobes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/stand_ins.h"

namespace kaustik::radiance {

Paint Paint::times(double factor) const { return {radiance::times(colour_, factor), texture_}; }

void Paint::put(Object& object, const std::string& name) const {
  if (!texture_) {
    give(object, name, colour_);
  } else if (colour_ == Rgb{1, 1, 1}) {
    nest(object, texture_, name);
  } else {
    const ObjectPointer scaled = make_object("texture", "scale", object.place);
    nest(*scaled, texture_, "value");
    give(*scaled, "scale", colour_);
    nest(object, scaled, name);
  }
}

ObjectPointer matt(const Paint& paint, const Place& place) {
  const ObjectPointer bsdf = make_object("bsdf", "diffuse", place);
  paint.put(*bsdf, "reflectance");
  return bsdf;
}

ObjectPointer perfect_mirror(const Paint& paint, const Place& place) {
  const ObjectPointer mirror = make_object("bsdf", "conductor", place);
  give(*mirror, "material", std::string("none"));
  paint.put(*mirror, "specular_reflectance");
  return mirror;
}

ObjectPointer two_sided(const ObjectPointer& bsdf) {
  const ObjectPointer both = make_object("bsdf", "twosided", bsdf->place);
  nest(*both, bsdf);
  return both;
}

ObjectPointer clear_pane(const Paint& paint, const Place& place) {
  const ObjectPointer pane = make_object("bsdf", "thindielectric", place);
  give(*pane, "int_ior", 1.0);
  give(*pane, "ext_ior", 1.0);
  paint.put(*pane, "specular_transmittance");
  return pane;
}

ObjectPointer picture_texture(const PicturePattern& picture, const Place& place) {
  if (picture.file().empty()) return missing_texture(place);
  const ObjectPointer bitmap = make_object("texture", "bitmap", place);
  give(*bitmap, "filename", picture.file());
  give(*bitmap, "wrap_mode", std::string(picture.repeats ? "repeat" : "clamp"));
  return bitmap;
}

void LobeSum::add(ObjectPointer bsdf, double share) {
  if (share > 0) parts_.emplace_back(std::move(bsdf), share);
}

ObjectPointer LobeSum::bsdf() const {
  if (parts_.empty()) return two_sided(matt(Paint(Rgb{0, 0, 0}), place_));
  double sum = 0;
  for (const auto& part : parts_) sum += part.second;
  const double scale = sum > 1 ? 1 / sum : 1;
  if (parts_.size() == 1 && sum * scale > 1 - 1e-9) return parts_[0].first;
  const ObjectPointer mixture = make_object("bsdf", "mixturebsdf", place_);
  std::string weights;
  for (const auto& [bsdf, share] : parts_) {
    weights += fmt::format("{}{}", weights.empty() ? "" : ", ", share * scale);
    nest(*mixture, bsdf);
  }
  give(*mixture, "weights", weights);
  return mixture;
}

double inner_reflectance(double index) {
  // Of light from the thinner side; those that enter are as many as those that leave, but for the
  // square of the index.
  constexpr int steps = 200;
  double outer = 0;
  for (int i = 0; i < steps; ++i) {
    const double cosine = std::sqrt((i + 0.5) / steps);  // even in cos²
    const double inside = std::sqrt(1 - (1 - cosine * cosine) / (index * index));
    const double s = (cosine - index * inside) / (cosine + index * inside);
    const double p = (inside - index * cosine) / (inside + index * cosine);
    outer += (s * s + p * p) / 2;
  }
  return 1 - (1 - outer / steps) / (index * index);
}

double index_by_reflectance(double reflectance) {
  const double root = std::sqrt(std::clamp(reflectance, 0.0, 0.99));
  return (1 + root) / (1 - root);
}

}  // namespace kaustik::radiance
