#pragma once
#include "kaustik/loader/radiance/bsdf_xml.h"
#include "kaustik/loader/radiance/lobes.h"
#include "kaustik/loader/radiance/materials.h"

namespace kaustik::radiance {

/// Makes the bsdf, the media and the emission of one material; `paint` is what patterns make of a
/// white colour.
class MaterialBuilder {
 public:
  MaterialBuilder(const Modifier& material, const Tint& tint, ObjectPointer texture,
                  const std::optional<BsdfShares>& measured, Deviations& deviations);

  void build(Appearance& made);

 private:
  /// Of number `first` and the next two; what is missing is `otherwise`.
  Rgb colour(size_t first, double otherwise = 0) const;
  double real(size_t index, double otherwise) const;
  /// A reflectance of the material, patterns in it; none above 1.
  Paint paint(const Rgb& colour) const;
  void approximated(const std::string& what) const;
  void ignored(const std::string& what) const;

  void build_plastic(Appearance& made, bool is_metal, double spec, double alpha_u, double alpha_v);
  ObjectPointer smooth_plastic(const Rgb& colour, double spec) const;
  void build_trans(Appearance& made, double spec, double alpha_u, double alpha_v, double trans,
                   double tspec);
  void build_anisotropic(Appearance& made);
  void build_glass(Appearance& made);
  void build_dielectric(Appearance& made);
  void build_interface(Appearance& made);
  void build_light(Appearance& made, bool is_visible);
  void build_spotlight(Appearance& made);
  void build_mirror(Appearance& made);
  void build_mist(Appearance& made);
  void build_measured(Appearance& made);
  void build_by_parts(Appearance& made, size_t reflected, size_t transmitted, const char* why);
  /// An absorbing medium by its transmission over one unit of length; null where that is all.
  ObjectPointer absorption(const Rgb& transmission) const;
  Rgb emitted() const;

  const Modifier& material_;
  const Tint& tint_;
  ObjectPointer texture_;
  const std::optional<BsdfShares>& measured_;  ///< of a BSDF's file
  Deviations& deviations_;
  const Place& place_;
};

}  // namespace kaustik::radiance
