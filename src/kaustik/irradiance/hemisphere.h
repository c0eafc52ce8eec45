#pragma once
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/base/spectrum.h"
#include "kaustik/geometry/ray.h"

namespace kaustik {

/// N_θ × N_φ cells over a hemisphere: cell (i, j) holds θ = asin √((i + s)/N_θ), φ = 2π (j + t)/N_φ
/// for s, t in [0, 1): all cells have the same projected solid angle π/(N_θ N_φ).
struct HemisphereGrid {
  int theta_cells = 0, phi_cells = 0;
  int count() const { return theta_cells * phi_cells; }
  /// Cell of a local direction (z up, z > 0).
  int cell_of(const Vec3f& local_direction) const;
  /// The direction at (s, t) in the cell.
  Vec3f direction(int cell, const Vec2f& st) const;
};

/// Radiance that arrives at a surface from somewhere.
class RadianceSource {
 public:
  virtual ~RadianceSource() = default;
  struct Incoming {
    Spectrum radiance;          ///< W/(sr·m²)
    float distance = infinity;  ///< to where it comes from; infinite: from beyond the scene
  };
  /// Along unit `direction`, away from the surface. Thread-safe.
  virtual Incoming incoming(const SurfacePoint& from, const Vec3f& direction,
                            Sampler& sampler) const = 0;
  /// Relative importance ≥ 0 of the cells in the hemisphere of `frame`.z, one number a cell; false
  /// if unknown (then all are alike).
  virtual bool importance(const SurfacePoint& at, const Frame& frame, const HemisphereGrid& grid,
                          std::vector<float>& cell_importance) const {
    (void)at, (void)frame, (void)grid, (void)cell_importance;
    return false;
  }
};

struct HemisphereSettings {
  int samples = 200;  ///< rays per record, at least one per cell
  /// Share of the samples that is spent by importance instead of evenly.
  float importance_share = 0.25f;
};

/// Irradiance at a point with what the cache needs to extrapolate it.
struct HemisphereEstimate {
  Spectrum irradiance;                               ///< W/m²
  Vec3f rotation_gradient[Spectrum::lane_count];     ///< per lane, W/m² per radian
  Vec3f translation_gradient[Spectrum::lane_count];  ///< per lane, W/m² per m
  float harmonic_distance = infinity;                ///< m
  float minimum_distance = infinity;                 ///< m
  uint32_t rays = 0;
};

/// Samples every cell of the hemisphere about `normal` at least once and derives irradiance and
/// gradients from the cells' means (Ward and Heckbert 1992, in the form for the mapping above;
/// Křivánek et al. 2005 for cell areas). The irradiance is unbiased.
HemisphereEstimate sample_hemisphere(const RadianceSource& source, const SurfacePoint& at,
                                     const Vec3f& normal, const HemisphereSettings& settings,
                                     const Sampler& sampler);

}  // namespace kaustik
