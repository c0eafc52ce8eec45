#include "kaustik/medium/medium.h"

namespace kaustik {

Spectrum AbsorbingMedium::transmittance(float distance) const {
  Spectrum result(1);
  // A lane that absorbs nothing stays 1 at an infinite distance too, where 0 · ∞ has no value.
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    if (absorption_[lane] > 0) result.set(lane, std::exp(-absorption_[lane] * distance));
  return result;
}

}  // namespace kaustik
