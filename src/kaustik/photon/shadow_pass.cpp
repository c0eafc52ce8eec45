#include "kaustik/photon/shadow_pass.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/parallel.h"
#include "kaustik/base/sampler.h"
#include "kaustik/scene/look_through.h"

namespace kaustik {
namespace {

constexpr uint32_t rays_per_block = 2048;

/// Rays of one light, `begin` to `end` of it, and what they left.
struct Block {
  int light;
  uint32_t begin, end;
  std::vector<Vec3f> positions{};
  std::vector<ShadowPhoton> photons{};
  uint64_t rays = 0, emitted = 0, lit = 0, cut = 0;
};

std::vector<Block> blocks_of(const std::vector<uint32_t>& shares) {
  std::vector<Block> blocks;
  for (size_t light = 0; light < shares.size(); ++light)
    for (uint32_t begin = 0; begin < shares[light]; begin += rays_per_block)
      blocks.push_back({int(light), begin, std::min(shares[light], begin + rays_per_block)});
  return blocks;
}

void store(const SurfacePoint& point, const Vec3f& direction, bool shadowed, Block& block) {
  const bool on_front = dot(direction, point.ng) < 0;
  ShadowPhoton photon;
  photon.side = CoarseNormal(on_front ? point.ng : -point.ng);
  photon.on_front = on_front;
  photon.light = uint32_t(block.light) & 0x7fffffffu;
  photon.shadowed = shadowed;
  block.positions.push_back(point.position);
  block.photons.push_back(photon);
  if (!shadowed) ++block.lit;
}

/// Through all surfaces until the ray leaves the scene.
void follow(const Scene& scene, const Ray& ray, const std::stop_token& stop, Block& block) {
  bool is_shadowed = false;
  const Look look = look_through(
      scene, ray, most_surfaces,
      [&](const Ray& next, Hit& hit) {
        if (stop.stop_requested()) return false;
        ++block.rays;
        return scene.intersect(next, hit);
      },
      [&](const SurfacePoint& point, const Hit&, const Ray& segment) {
        if (any(scene.surface(point.shape).traits.lobes & (Lobes::diffuse | Lobes::glossy)))
          store(point, segment.direction, is_shadowed, block);
        is_shadowed = true;
        return false;
      },
      straight_on);
  if (look == Look::too_deep) ++block.cut;
}

void trace(const Scene& scene, const EmissionSampler& emission, uint64_t seed, uint32_t pass,
           const std::stop_token& stop, Block& block) {
  for (uint32_t i = block.begin; i < block.end; ++i) {
    Sampler sampler = Sampler::at(seed, pass, Stream::photon_shadow, uint64_t(block.light), i);
    const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    const EmittedRay emitted =
        emission.sample(block.light, u_position, u_direction, sampler.next_1d(), {});
    if (emitted.flux.is_zero()) continue;
    ++block.emitted;
    follow(scene, emitted.ray, stop, block);
  }
}

}  // namespace

std::vector<std::string> ShadowReport::warnings() const {
  const auto left_none = [](const ShadowCounts& c) { return c.lit + c.shadowed == 0; };
  std::vector<std::string> warnings;
  if (std::all_of(lights.begin(), lights.end(), left_none))
    warnings.emplace_back(
        "the shadow map is empty, shadow rays alone serve: no light shines on a surface that is "
        "more than mirror or clear glass");
  else if (std::any_of(lights.begin(), lights.end(), left_none))
    warnings.emplace_back(
        "some lights have no shadow photons, shadow rays alone serve them: their share of the rays "
        "is too small, or they shine on nothing but mirrors and clear glass");
  if (cut > 0)
    warnings.push_back(fmt::format(
        "rays for shadow photons were given up behind {} surfaces: what lies farther has too few",
        most_surfaces));
  return warnings;
}

ShadowMap trace_shadow_photons(const Scene& scene, uint32_t count, uint64_t seed, uint32_t pass,
                               std::stop_token stop, ShadowReport& report) {
  std::vector<double> powers;
  for (const auto& light : scene.lights()) powers.push_back(double(light->traits().power.sum()));
  report = {};
  report.lights.resize(powers.size());
  if (count == 0) return {};
  std::vector<Block> blocks = blocks_of(share_photons(count, powers, powers));
  const EmissionSampler emission(scene);
  parallel_blocks(blocks.size(), 1, [&](size_t i, size_t, size_t) {
    if (!stop.stop_requested()) trace(scene, emission, seed, pass, stop, blocks[i]);
  });
  std::vector<Vec3f> positions;
  std::vector<ShadowPhoton> photons;
  for (const Block& block : blocks) {
    ShadowCounts& counts = report.lights[size_t(block.light)];
    counts.emitted += block.emitted;
    counts.lit += block.lit;
    counts.shadowed += block.photons.size() - block.lit;
    report.rays += block.rays;
    report.cut += block.cut;
    positions.insert(positions.end(), block.positions.begin(), block.positions.end());
    photons.insert(photons.end(), block.photons.begin(), block.photons.end());
  }
  return {std::move(positions), std::move(photons)};
}

}  // namespace kaustik
