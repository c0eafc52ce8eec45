#pragma once
#include "kaustik/base/spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Irradiance around a point of a surface, as the octree hands it out.
struct CacheRecord {
  Vec3f position;
  Vec3f normal;
  float reach = 0;  ///< m: how far it serves on a plane, > 0 …
  /// … and in which direction less: a tangent vector of length √(1/r² − 1/reach²), 1/m, where r is
  /// the reach in its direction; zero: it serves equally far all around.
  Vec3f squeeze{0, 0, 0};
  /// Share of its weight that it has among other records, in (0, 1]: one that knows only a groove
  /// but has to serve as far as the least spacing must not darken what lies beside it.
  float confidence = 1;
  /// How much more than elsewhere turned normals count, ≥ 1: where irradiance falls off quickly as
  /// the normal turns, as at the border of the lit half of a ball, its gradient does not hold far.
  float turning = 1;
  /// Of the pixel that it was made for, m; 0: unknown. The reach is meant for points whose pixels
  /// are about as wide; see RecordOctree.
  float pixel_width = 0;
  Spectrum irradiance;  ///< W/m²
  /// By axis x, y, z: what is added per metre that the point moves …
  Spectrum per_metre[3];
  /// … and per unit that the normal changes.
  Spectrum per_normal[3];

  float inverse_reach_sq() const { return 1 / sqr(reach); }
  /// 1/r² of the shorter reach.
  float inverse_minor_sq() const { return inverse_reach_sq() + length_sq(squeeze); }

  /// Irradiance at `offset` from the position with another normal; may be negative.
  Spectrum extrapolate(const Vec3f& offset, const Vec3f& other_normal) const {
    const Vec3f turn = other_normal - normal;
    return irradiance + per_metre[0] * offset.x + per_metre[1] * offset.y +
           per_metre[2] * offset.z + per_normal[0] * turn.x + per_normal[1] * turn.y +
           per_normal[2] * turn.z;
  }
};

}  // namespace kaustik
