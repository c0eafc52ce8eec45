#include "kaustik/material/albedo_table.h"

#include "kaustik/base/sampler.h"

namespace kaustik {
namespace {

constexpr int cosines = 33;
constexpr int samples_per_node = 512;

/// Node i lies at cosθ = (i/(cosines − 1))², denser toward the horizon where the albedo bends.
float cosine_of_node(int i) { return std::max(1e-3f, sqr(float(i) / float(cosines - 1))); }

struct Position {
  int index;
  float weight;  ///< of the next node
};
Position position(float at, int count) {
  const int index = std::clamp(int(at), 0, count - 2);
  return {index, std::clamp(at - float(index), 0.0f, 1.0f)};
}

Spectrum mix(const Spectrum& a, const Spectrum& b, float weight) {
  return a * (1 - weight) + b * weight;
}

}  // namespace

AlbedoTable::AlbedoTable(bool isotropic,
                         const std::function<Spectrum(const Vec3f&, const Vec2f&)>& weight)
    : azimuths_(isotropic ? 1 : 9) {
  for (int azimuth = 0; azimuth < azimuths_; ++azimuth) {
    const float phi = isotropic ? 0 : 0.5f * pi * float(azimuth) / float(azimuths_ - 1);
    for (int i = 0; i < cosines; ++i) {
      const float z = cosine_of_node(i), r = safe_sqrt(1 - z * z);
      const Vec3f wo(r * std::cos(phi), r * std::sin(phi), z);
      Spectrum sum;
      for (uint32_t n = 0; n < samples_per_node; ++n)
        sum += weight(wo, Sampler(uint64_t(nodes_.size()), n).next_2d());
      nodes_.push_back(sum / float(samples_per_node));
    }
  }
}

Spectrum AlbedoTable::operator()(const Vec3f& wo) const {
  const Position c = position(safe_sqrt(wo.z) * float(cosines - 1), cosines);
  const auto along = [&](int azimuth) {
    const size_t node = size_t(azimuth * cosines + c.index);
    return mix(nodes_[node], nodes_[node + 1], c.weight);
  };
  if (azimuths_ == 1) return along(0);
  const float phi = std::atan2(std::fabs(wo.y), std::fabs(wo.x));
  const Position a = position(phi * (2 / pi) * float(azimuths_ - 1), azimuths_);
  return mix(along(a.index), along(a.index + 1), a.weight);
}

AlbedoTables::AlbedoTables(float low, float high, bool isotropic,
                           const std::function<Spectrum(float, const Vec3f&, const Vec2f&)>& weight)
    : low_(low), high_(high) {
  constexpr int count = 9;
  for (int i = 0; i < (high > low ? count : 1); ++i) {
    const float parameter = low + (high - low) * float(i) / float(count - 1);
    tables_.emplace_back(isotropic,
                         [&](const Vec3f& wo, const Vec2f& u) { return weight(parameter, wo, u); });
  }
}

Spectrum AlbedoTables::operator()(float parameter, const Vec3f& wo) const {
  if (tables_.size() == 1) return tables_.front()(wo);
  const float share = std::clamp((parameter - low_) / (high_ - low_), 0.0f, 1.0f);
  const Position p = position(share * float(tables_.size() - 1), int(tables_.size()));
  return mix(tables_[size_t(p.index)](wo), tables_[size_t(p.index) + 1](wo), p.weight);
}

}  // namespace kaustik
