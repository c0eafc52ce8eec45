#pragma once
// Materials of Radiance as bsdfs, media and emission.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/loader/radiance/tint.h"

namespace kaustik::radiance {

/// The light of a lamp that is another one in each direction: a radiance times patterns.
struct DirectedLight {
  Rgb radiance;
  DirectedPatterns patterns;
};

/// What a surface needs to be described.
struct Appearance {
  ObjectPointer bsdf;                ///< null: nothing is there
  ObjectPointer interior, exterior;  ///< media; may be null
  ObjectPointer emitter;             ///< null: it does not shine
  /// Of some lamps: how they really shine; the emitter has their mean.
  std::optional<DirectedLight> directed;
  /// Of a spotlight: radiance, whole angle in degrees, and axis in the world.
  struct Beam {
    Rgb radiance;
    double degrees = 0;
    Vec3d axis;
  };
  std::optional<Beam> beam;
  /// Where texture coordinates come from; null: it needs none.
  std::shared_ptr<const PicturePattern> picture;
  std::shared_ptr<PatternGrid> grid;  ///< to be told of where the surface is; may be null
  std::optional<Vec3d> tangent;       ///< in the world, of highlights that are longer along it
};

/// Makes appearances, each once.
class MaterialMaker {
 public:
  MaterialMaker(PatternReader& patterns, Deviations& deviations)
      : patterns_(patterns), tints_(patterns, deviations), deviations_(deviations) {}

  /// Of a surface with that modifier, which must stay where it is; null: void. On meshes it may
  /// have pictures. `samples`, at least one, are points of the first surface that has it.
  std::shared_ptr<const Appearance> appearance(const Modifier* modifier, bool is_mesh,
                                               const std::vector<PatternPoint>& samples);
  /// The radiance of a light material on a source at infinity, without its patterns; these are
  /// in the look. Nothing where the material does not shine.
  static std::optional<Rgb> radiance_of(const Modifier& material);

  /// Fills the grids of all patterns in space.
  void finish();

 private:
  friend class MaterialBuilder;
  std::shared_ptr<Appearance> make(const Modifier* modifier, bool is_mesh,
                                   const std::vector<PatternPoint>& samples);
  std::shared_ptr<Appearance> make_mixture(const Look& look, bool is_mesh,
                                           const std::vector<PatternPoint>& samples);

  PatternReader& patterns_;
  TintReader tints_;
  Deviations& deviations_;
  std::map<std::pair<const Modifier*, bool>, std::shared_ptr<Appearance>> known_;
  std::vector<std::pair<std::shared_ptr<PatternGrid>, const Modifier*>> grids_;
};

}  // namespace kaustik::radiance
