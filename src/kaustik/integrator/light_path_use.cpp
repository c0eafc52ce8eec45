#include "kaustik/integrator/light_path_use.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/merge_disk.h"
#include "kaustik/transport/direct_light.h"

namespace kaustik {
namespace {

/// Probes that there are at most, or a few more.
constexpr double most_probes = 1024;
constexpr int least_block = 4;
/// Of the random numbers' addresses.
constexpr uint64_t direct_element = uint64_t(3) << 40;
constexpr int direct_samples = 4;
/// Of the mean over the probes: light that counts where there is less. What is dark may be noisy.
constexpr double least_light = 0.05;
/// Boxes that the probes are put into.
constexpr size_t most_targets = 32;

int block_size(const Vec2i& pixels) {
  const double each = double(pixels.x) * double(pixels.y) / most_probes;
  return std::max(least_block, int(std::ceil(std::sqrt(each))));
}

float direct_light_at(const Scene& scene, const SurfaceVertex& vertex, uint64_t probe) {
  Sampler sampler = Sampler::at(0, 0, Stream::training, direct_element + probe, 0);
  uint64_t rays = 0;
  const auto reflect = [&](const DirectLight& light, ShadowAnswer& answer) {
    const Spectrum reflected = vertex.eval_cosine(light.wi, Lobes::all);
    if (reflected.is_zero()) return Spectrum();
    const Medium* medium = vertex.medium_toward(light.wi, nullptr);
    return reflected * light.radiance * trace_shadow_ray(scene, light, medium, rays, answer);
  };
  return sample_direct_lights<Spectrum>(scene, Receiver(vertex, 1),
                                        {LightChoice::one, direct_samples}, sampler, reflect)
      .sum();
}

/// At most `count` boxes with about as many of the points in each.
std::vector<AimTarget> boxes_around(std::vector<Vec3f> points, size_t count) {
  struct Range {
    size_t begin, end;
  };
  std::vector<Range> ranges;
  if (!points.empty()) ranges.push_back({0, points.size()});
  const auto bounds_of = [&](const Range& range) {
    Bounds3f box;
    for (size_t i = range.begin; i < range.end; ++i) box.extendBy(points[i]);
    return box;
  };
  while (!ranges.empty() && 2 * ranges.size() <= count) {
    std::vector<Range> halves;
    for (const Range& range : ranges) {
      const size_t middle = (range.begin + range.end) / 2;
      if (middle == range.begin) {
        halves.push_back(range);
        continue;
      }
      const int axis = int(bounds_of(range).majorAxis());
      const auto at = [&](size_t i) { return points.begin() + std::ptrdiff_t(i); };
      std::nth_element(at(range.begin), at(middle), at(range.end),
                       [axis](const Vec3f& a, const Vec3f& b) { return a[axis] < b[axis]; });
      halves.push_back({range.begin, middle});
      halves.push_back({middle, range.end});
    }
    if (halves.size() == ranges.size()) break;
    ranges = std::move(halves);
  }
  std::vector<AimTarget> targets;
  for (const Range& range : ranges) targets.push_back({bounds_of(range), 1, 0});
  return targets;
}

}  // namespace

LightPathUse::LightPathUse(const Scene& scene, const LightPathEmission& plain, ComponentSet wanted)
    : wanted_(wanted), emission_(plain) {
  const Vec2i size = scene.film().crop_size;
  const int block = block_size(size);
  reach_ = 0.5f * float(block);
  const Vec2i blocks = (size + Vec2i(block - 1)) / block;
  probes_ = make_pixel_probes(scene, blocks, block);
  direct_.resize(probes_.size());
  arrived_.resize(probes_.size());
  parallel_blocks(probes_.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t p = begin; p < end; ++p)
      if (probes_[p].found && wanted_.has(probes_[p].path.component_after(Lobes::diffuse)))
        direct_[p] = direct_light_at(scene, probes_[p].vertex, p);
  });
}

std::vector<AimTarget> LightPathUse::targets() const {
  std::vector<Vec3f> points;
  for (const PixelProbe& probe : probes_)
    if (probe.found) points.push_back(probe.vertex.position());
  return boxes_around(std::move(points), most_targets);
}

std::vector<LightPathUse::Arrival> LightPathUse::arrivals(const LightVertices& light) const {
  std::vector<uint32_t> beginning_of(light.beginnings.back().path + 1);
  for (size_t i = 0; i < light.beginnings.size(); ++i)
    beginning_of[light.beginnings[i].path] = uint32_t(i);
  constexpr size_t per_block = 16;
  std::vector<std::vector<Arrival>> found((probes_.size() + per_block - 1) / per_block);
  parallel_blocks(probes_.size(), per_block, [&](size_t begin, size_t end, size_t block) {
    for (size_t p = begin; p < end; ++p) {
      const PixelProbe& probe = probes_[p];
      const float radius = reach_ * probe.pixel_width;
      if (!probe.found || !(radius > 0)) continue;
      const MergeDisk disk(probe.vertex, radius);
      light.tree.within(
          probe.vertex.position(), disk.side(), false, sqr(radius), [&](uint32_t index, float) {
            const LightVertexData& photon = light.tree.tree().data(index);
            if (photon.path >= beginning_of.size()) return;
            const Vec3f offset = light.tree.tree().key(index) - probe.vertex.position();
            const float value = probe.sent(photon, wanted_).sum() *
                                disk.share(offset, photon.side) * inv_pi / sqr(radius);
            if (value > 0) found[block].push_back({uint32_t(p), beginning_of[photon.path], value});
          });
    }
  });
  std::vector<Arrival> result;
  for (const auto& of_block : found) result.insert(result.end(), of_block.begin(), of_block.end());
  return result;
}

std::vector<double> LightPathUse::totals() const {
  std::vector<double> result(probes_.size());
  double sum = 0, count = 0;
  for (size_t p = 0; p < probes_.size(); ++p) {
    result[p] = double(direct_[p]) + arrived_[p] / paths_;
    if (probes_[p].found) sum += result[p], ++count;
  }
  for (double& total : result) total += count > 0 ? least_light * sum / count : 0.0;
  return result;
}

void LightPathUse::learn(const LightVertices& light) {
  paths_ += double(light.remembered_paths);
  if (light.beginnings.empty() || light.tree.empty()) return;
  const std::vector<Arrival> all = arrivals(light);
  for (const Arrival& arrival : all) arrived_[arrival.probe] += double(arrival.light);
  const std::vector<double> total = totals();
  std::vector<double> squares(light.beginnings.size());
  for (const Arrival& arrival : all) {
    const double of_all = total[arrival.probe];
    if (!(of_all > 0)) continue;
    const double use = std::min(double(arrival.light) / of_all, double(light.remembered_paths));
    squares[arrival.beginning] += use * use;
  }
  for (size_t i = 0; i < squares.size(); ++i)
    if (squares[i] > 0) emission_.add(light.beginnings[i].start, std::sqrt(squares[i]));
}

}  // namespace kaustik
