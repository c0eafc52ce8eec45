#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/base/scratch.h"
#include "kaustik/base/spectrum.h"
#include "kaustik/geometry/ray.h"
#include "kaustik/medium/medium.h"

namespace kaustik {

/// N_θ × N_φ cells over a hemisphere: cell (i, j) holds θ = asin √((i + s)/N_θ), φ = 2π (j + t)/N_φ
/// for s, t in [0, 1): all cells have the same projected solid angle π/(N_θ N_φ). Its number is
/// i N_φ + j.
struct HemisphereGrid {
  int theta_cells = 0, phi_cells = 0;

  /// The grid of at most `samples` (≥ 1) cells with N_φ ≈ π N_θ, where cells are about as wide as
  /// high (Ward and Heckbert 1992).
  static HemisphereGrid for_samples(int samples);
  int count() const { return theta_cells * phi_cells; }
  /// Cell of a unit local direction (z up, z > 0).
  int cell_of(const Vec3f& local_direction) const;
  /// The direction at (s, t) in the cell; its z is always positive.
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
  /// Along unit `direction`, away from the surface. Thread-safe. `sampler` stands at the start of
  /// the block of vertex 0.
  virtual Incoming incoming(const SurfacePoint& from, const Vec3f& direction,
                            Sampler& sampler) const = 0;
  /// The same where the surface lies in `medium` (null: vacuum), for sources that know media, and
  /// with lists for those that need some.
  virtual Incoming incoming_through(const Medium* medium, const SurfacePoint& from,
                                    const Vec3f& direction, Sampler& sampler,
                                    Scratch& scratch) const {
    (void)medium, (void)scratch;
    return incoming(from, direction, sampler);
  }
  /// Relative importance ≥ 0 of the cells in the hemisphere of `frame`.z, one number a cell; false
  /// if unknown (then all are alike). Called before any ray of that hemisphere is traced.
  virtual bool importance(const SurfacePoint& at, const Frame& frame, const HemisphereGrid& grid,
                          Scratch& scratch, std::vector<float>& cell_importance) const {
    (void)at, (void)frame, (void)grid, (void)scratch, (void)cell_importance;
    return false;
  }
};

struct HemisphereSettings {
  int samples = 200;  ///< rays per record, at least one per cell
  /// Share of the samples that is spent by importance instead of evenly, in [0, 1).
  float importance_share = 0.25f;
  bool hessian = false;  ///< the estimate's translation_hessian is wanted
};

/// A symmetric matrix in a tangent plane, per lane.
struct TangentHessian {
  Spectrum xx, xy, yy;
};

/// Irradiance at a point with what the cache needs to extrapolate it. To first order the irradiance
/// at x' with normal n' is E + (x' − x) · translation_gradient + (n × n') · rotation_gradient.
struct HemisphereEstimate {
  Spectrum irradiance;                               ///< W/m²
  Vec3f rotation_gradient[Spectrum::lane_count];     ///< per lane, W/m² per radian
  Vec3f translation_gradient[Spectrum::lane_count];  ///< per lane, W/m² per m, in the tangent plane
  /// W/m² per m², in the x and y axes of Frame(normal); zero where it isn't wanted.
  TangentHessian translation_hessian;
  float harmonic_distance = infinity;  ///< m, over projected solid angle; infinite: all open
  float minimum_distance = infinity;   ///< m
  uint32_t rays = 0;
  uint32_t dropped = 0;  ///< rays whose radiance was not finite: left out of their cell's mean
};

/// Samples every cell of the hemisphere about unit `normal` at least once and derives irradiance
/// and gradients from the cells' means (Ward and Heckbert 1992, in the form for the mapping above).
/// The irradiance is unbiased: how many samples a cell gets is settled before any is seen.
/// Directions below the geometric surface carry nothing and cost no ray. `medium`: that the light
/// arrives through.
HemisphereEstimate sample_hemisphere(const RadianceSource& source, const SurfacePoint& at,
                                     const Vec3f& normal, const HemisphereSettings& settings,
                                     const Sampler& sampler, const Medium* medium = nullptr);

}  // namespace kaustik
