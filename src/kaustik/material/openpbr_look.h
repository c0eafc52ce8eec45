#pragma once
#include <array>
#include <memory>
#include <vector>

#include "kaustik/material/bsdf.h"
#include "kaustik/material/share.h"

namespace kaustik {

/// What the parameters of 'openpbr' say of one point.
struct OpenPbrLook {
  Spectrum base_color, specular_color, transmission_color, subsurface_color, coat_color, fuzz_color;
  Spectrum white;  ///< full reflection in every lane that carries light
  float diffuse_roughness = 0, metalness = 0, specular_weight = 0, transmission = 0, subsurface = 0,
        coat = 0, coat_darkening = 0, fuzz = 0, fuzz_roughness = 0;
  /// By the parameters of burley_facets(); the base's with what a rough coat adds.
  float roughness = 0, anisotropic = 0, coat_roughness = 0, coat_anisotropic = 0;

  /// Shares of the base that scatter beneath their surface, and let light through.
  float opaque() const { return (1 - metalness) * (1 - transmission); }
  float clear() const { return (1 - metalness) * transmission; }
};

/// The parameters themselves, by the names and usual values of the OpenPBR Surface specification
/// 1.1 (Academy Software Foundation, 2024).
class OpenPbrParameters {
 public:
  explicit OpenPbrParameters(const BsdfInputs& inputs);
  static std::vector<Parameter> rows();

  SurfaceNeeds needs() const;
  OpenPbrLook at(const BsdfContext& context) const;
  bool may_transmit() const;  ///< by its transmission, or as a sheet
  bool may_be_pane() const;   ///< somewhere
  /// Whether light goes straight on through its glass there.
  bool is_pane(const OpenPbrLook& look) const;
  bool is_sheet() const { return is_sheet_; }
  bool has_coat() const { return !coat_.is_zero(); }
  bool has_fuzz() const { return !fuzz_.is_zero(); }
  /// Whether coat and fuzz are the same everywhere.
  bool has_constant_layers() const;
  /// Whether, besides, all that tells how much light the surface of the base reflects is.
  bool has_constant_surface() const;
  /// n_interior/n_exterior of the base, and of the coat.
  float base_eta() const { return base_eta_; }
  float coat_eta() const { return coat_eta_; }
  /// Of burley_facets(), for tables.
  float mean_anisotropic() const;
  float mean_coat_anisotropic() const;
  /// From −1 to 1: how much more of what scatters inside a sheet goes on than comes back.
  float forward() const { return forward_; }

 private:
  /// A colour; constant ones take no place in the context's memory.
  using Color = std::shared_ptr<const Texture>;
  static Spectrum color_at(const BsdfContext& context, const Color& color);
  std::array<const Share*, 14> shares() const;
  std::array<const Texture*, 6> colors() const;

  Color base_color_, specular_color_, transmission_color_, subsurface_color_, coat_color_,
      fuzz_color_;
  Share base_weight_, diffuse_roughness_, metalness_, specular_weight_, specular_roughness_,
      specular_anisotropy_, transmission_, subsurface_, coat_, coat_roughness_, coat_anisotropy_,
      coat_darkening_, fuzz_, fuzz_roughness_;
  float base_eta_, coat_eta_, forward_;
  bool is_sheet_;
};

}  // namespace kaustik
