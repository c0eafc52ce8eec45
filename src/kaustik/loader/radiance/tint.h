#pragma once
// What the patterns of a chain do to a colour, in terms of what textures there are.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/loader/radiance/pattern_grid.h"
#include "kaustik/loader/radiance/patterns.h"

namespace kaustik::radiance {

/// Patterns that depend on the direction, with where they are defined.
using DirectedPatterns = std::vector<std::pair<std::shared_ptr<const Pattern>, const Modifier*>>;

/// A factor that is the same everywhere, times a picture or a pattern in space.
struct Tint {
  Rgb factor{1, 1, 1};
  const Modifier* picture_modifier = nullptr;  ///< null: none
  std::shared_ptr<const PicturePattern> picture;
  std::vector<std::shared_ptr<const Pattern>> in_space;
  /// Of lamps: those that depend on the direction, and the factor without them.
  DirectedPatterns directed;
  Rgb even_factor{1, 1, 1};

  bool is_textured() const { return picture_modifier || !in_space.empty(); }
};

/// Takes patterns apart.
class TintReader {
 public:
  TintReader(PatternReader& reader, Deviations& deviations)
      : reader_(reader), deviations_(deviations) {}

  /// `samples` are points of the surface, for means. Pictures and patterns in space are kept where
  /// the surface can have textures; else they count by their means. Of lamps those that depend on
  /// the direction are kept, too, and nothing is told of them.
  Tint tint_of(const std::vector<const Modifier*>& patterns,
               const std::vector<PatternPoint>& samples, bool may_have_pictures, bool may_vary,
               bool is_lamp = false);

 private:
  void add(const Modifier& modifier, const std::vector<PatternPoint>& samples, bool may_vary,
           bool is_lamp, Tint& tint);

  PatternReader& reader_;
  Deviations& deviations_;
};

/// What to tell of a lamp whose luminance is more than 1 % off, because the colours of Radiance are
/// others than those of Rec. 709; "" for others.
std::string luminance_remark(const Rgb& radiance);

inline Rgb product(const Rgb& a, const Rgb& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Rgb times(const Rgb& a, double factor) { return {a.r * factor, a.g * factor, a.b * factor}; }
inline double largest_of(const Rgb& c) { return std::max({c.r, c.g, c.b}); }
inline Rgb clamped(const Rgb& c, double most = 1) {
  return {std::clamp(c.r, 0.0, most), std::clamp(c.g, 0.0, most), std::clamp(c.b, 0.0, most)};
}

}  // namespace kaustik::radiance
