#pragma once
#include <span>
#include <vector>

#include "kaustik/session.h"

namespace kaustik::v0 {

/// What was measured, one for each point or ray, in their order.
struct KAUSTIK_EXPORT Estimates {
  std::vector<Estimate> luminance;  ///< W/m² or W/(sr·m²); 179 of them are lux, or cd/m²
  std::vector<Rgb> rgb;             ///< the same in linear Rec. 709
  /// That holds them, one in each pixel, row by row; pixels after the last are 0.
  Picture picture;
};

/// The irradiance, W/m², at points in the air and on surfaces, each on the side of its normal (of
/// any length; a single one is that of all). All lamps count, and caustics. The points are as if
/// they were not there; one that lies on a surface, to a hundred thousandth of the scene's size,
/// measures what arrives there. The scene's cameras do not count, and it needs none.
///
/// Without an integrator in the settings it is "auto", whatever the scene's is. Without passes,
/// samples, a time or an error each point gets 1024 samples. `settings.camera` must not be given.
/// Renders in this thread and others, as Session::run(). Throws Error for what is wrong with the
/// arguments or the scene; for lists its file() is "points" or "normals".
KAUSTIK_EXPORT Estimates irradiance(const Scene& scene, std::span<const Vec3> points,
                                    std::span<const Vec3> normals,
                                    const SessionSettings& settings = {}, Callbacks callbacks = {});

/// The radiance, W/(sr·m²), that arrives along rays: at `origins` (a single one is that of all)
/// from where `directions`, of any length, look. The rest is as for irradiance().
KAUSTIK_EXPORT Estimates radiance(const Scene& scene, std::span<const Vec3> origins,
                                  std::span<const Vec3> directions,
                                  const SessionSettings& settings = {}, Callbacks callbacks = {});

}  // namespace kaustik::v0
