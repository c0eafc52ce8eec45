#include "kaustik/material/albedo_table.h"

#include "kaustik/base/sampler.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

constexpr int cosines = 33;
constexpr int samples_per_node = 512;
constexpr int parameters = 9;

/// Node i lies at cosθ = (i/(cosines − 1))², denser toward the horizon where the albedo bends.
float cosine_of_node(int i) { return std::max(1e-3f, sqr(float(i) / float(cosines - 1))); }

struct Position {
  int index;
  float weight;  ///< of the next node
};
Position position(float at, int count) {
  const int index = to_integer(at, 0, count - 2);
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
        sum += weight(wo, Sampler::of(Quadrature::albedo, n, nodes_.size()).next_2d());
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

AlbedoTables::AlbedoTables(float low, float high, bool isotropic, Weight weight)
    : low_(low),
      high_(high),
      isotropic_(isotropic),
      weight_(std::move(weight)),
      tables_(high > low ? parameters : 1) {}

float AlbedoTables::parameter_of(size_t index) const {
  return low_ + (high_ - low_) * float(index) / float(parameters - 1);
}

const AlbedoTable& AlbedoTables::table(size_t index) const {
  Lazy& lazy = tables_[index];
  std::call_once(lazy.once, [&] {
    const float parameter = parameter_of(index);
    lazy.table.emplace(isotropic_,
                       [&](const Vec3f& wo, const Vec2f& u) { return weight_(parameter, wo, u); });
  });
  return *lazy.table;
}

Spectrum AlbedoTables::operator()(float parameter, const Vec3f& wo) const {
  if (tables_.size() == 1) return table(0)(wo);
  const float share = std::clamp((parameter - low_) / (high_ - low_), 0.0f, 1.0f);
  const Position p = position(share * float(tables_.size() - 1), int(tables_.size()));
  return mix(table(size_t(p.index))(wo), table(size_t(p.index) + 1)(wo), p.weight);
}

}  // namespace kaustik
