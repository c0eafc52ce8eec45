#pragma once
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "kaustik/base/spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Directional albedo of a reflecting lobe by the direction of view, computed once by sampling;
/// good to about a percent.
class AlbedoTable {
 public:
  /// `weight(wo, u)`: the lobe's f·cosθ_i/pdf for a direction sampled with u, zero where absorbed.
  AlbedoTable(bool isotropic, const std::function<Spectrum(const Vec3f&, const Vec2f&)>& weight);
  /// wo.z > 0.
  Spectrum operator()(const Vec3f& wo) const;

 private:
  int azimuths_;  ///< over a quarter turn; 1: isotropic
  std::vector<Spectrum> nodes_;
};

/// The same for a lobe with a parameter that varies from `low` to `high`. Each table is made when
/// it is first asked for, by any thread: a scene may have thousands of materials, and see a few.
class AlbedoTables {
 public:
  using Weight = std::function<Spectrum(float, const Vec3f&, const Vec2f&)>;
  /// `weight(parameter, wo, u)` as above; kept, so that what it refers to must outlive the tables.
  AlbedoTables(float low, float high, bool isotropic, Weight weight);
  Spectrum operator()(float parameter, const Vec3f& wo) const;

 private:
  struct Lazy {
    std::once_flag once;
    std::optional<AlbedoTable> table;
  };
  const AlbedoTable& table(size_t index) const;
  float parameter_of(size_t index) const;

  float low_, high_;
  bool isotropic_;
  Weight weight_;
  mutable std::vector<Lazy> tables_;
};

}  // namespace kaustik
