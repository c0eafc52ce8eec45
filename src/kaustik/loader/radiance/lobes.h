#pragma once
// Bsdfs by their parts.

#include <vector>

#include "kaustik/loader/radiance/objects.h"
#include "kaustik/loader/radiance/tint.h"

namespace kaustik::radiance {

/// A colour, or a texture times a colour.
class Paint {
 public:
  explicit Paint(const Rgb& colour) : colour_(colour) {}
  Paint(const Rgb& colour, ObjectPointer texture) : colour_(colour), texture_(std::move(texture)) {}

  bool is_textured() const { return texture_ != nullptr; }
  const Rgb& colour() const { return colour_; }
  Paint times(double factor) const;
  /// As a parameter of an object.
  void put(Object& object, const std::string& name) const;

 private:
  Rgb colour_;
  ObjectPointer texture_;
};

ObjectPointer matt(const Paint& paint, const Place& place);
ObjectPointer perfect_mirror(const Paint& paint, const Place& place);
/// Seen alike from both sides.
ObjectPointer two_sided(const ObjectPointer& bsdf);
/// Lets light pass straight on, times the paint.
ObjectPointer clear_pane(const Paint& paint, const Place& place);
/// The texture of a picture; where there is none, a checker of magenta.
ObjectPointer picture_texture(const PicturePattern& picture, const Place& place);

/// The sum of bsdfs that are seen from both sides, each with its share of the light.
class LobeSum {
 public:
  explicit LobeSum(Place place) : place_(std::move(place)) {}
  /// `bsdf` counts `share` times.
  void add(ObjectPointer bsdf, double share);
  ObjectPointer bsdf() const;

 private:
  Place place_;
  std::vector<std::pair<ObjectPointer, double>> parts_;
};

/// Share of light that comes evenly from the denser side and is thrown back, for an index of
/// refraction above 1.
double inner_reflectance(double index);
/// The index of a surface that reflects that share at normal incidence.
double index_by_reflectance(double reflectance);

}  // namespace kaustik::radiance
