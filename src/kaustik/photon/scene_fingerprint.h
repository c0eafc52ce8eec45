#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "kaustik/scene/scene.h"

namespace kaustik {

/// What tells scenes apart whose photons differ: counts, and a few sums over all numbers that say
/// where shapes stand, how they scatter, and what lights send out, each number with a sign that is
/// drawn for it. A number that changes by d changes all sums by d, and many changes hardly cancel
/// out in all of them; last bits, in which programs from different compilers differ, change them by
/// next to nothing. The camera makes no difference.
struct SceneFingerprint {
  static constexpr size_t sum_count = 16;

  std::string counts;  ///< of shapes, triangles and lights, for people too
  uint64_t numbers = 0;
  std::array<double, sum_count> sums{};  ///< places relative to the size of the scene

  /// Whether both are of one scene, last bits apart. Not told is a change of all numbers together
  /// by less than 2e-6 times the root of their number (some 25 for each shape): in a scene of 1000
  /// shapes a ball that moves by 0.03 % of the scene's size.
  bool matches(const SceneFingerprint& other) const;
};

SceneFingerprint fingerprint_of(const Scene& scene);

}  // namespace kaustik
