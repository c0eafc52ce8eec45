#pragma once
#include <memory>
#include <vector>

#include "kaustik/loader/radiance/objects.h"
#include "kaustik/loader/radiance/patterns.h"

namespace kaustik::radiance {

/// Patterns that vary in space, sampled over the box around the surfaces that have them: a volume
/// that the texture shows. Filled when all surfaces are known.
class PatternGrid {
 public:
  PatternGrid(std::vector<std::shared_ptr<const Pattern>> patterns, const Rgb& colour,
              const Place& place);

  /// A texture of that colour times the patterns, none above 1.
  const ObjectPointer& texture() const { return texture_; }
  /// A surface is there.
  void extend(const Vec3d& position, const Vec3d& normal);
  /// With at most so many samples. False where a pattern has no value at some of them.
  bool fill(size_t most_samples);
  /// Between samples, once filled.
  double spacing() const { return spacing_; }

 private:
  std::vector<std::shared_ptr<const Pattern>> patterns_;
  Rgb colour_;
  ObjectPointer texture_, volume_;
  Vec3d low_{0, 0, 0}, high_{0, 0, 0}, normal_{0, 0, 1};
  bool is_empty_ = true;
  double spacing_ = 0;
};

}  // namespace kaustik::radiance
