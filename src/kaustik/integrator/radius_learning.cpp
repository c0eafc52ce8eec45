#include "kaustik/integrator/radius_learning.h"

#include <algorithm>
#include <atomic>

#include "kaustik/base/parallel.h"
#include "kaustik/base/sampler.h"
#include "kaustik/integrator/merge_disk.h"

namespace kaustik {
namespace {

/// Of the random numbers' addresses.
constexpr uint64_t coverage_element = uint64_t(2) << 40;
/// Points that tell how much is covered of the smallest disk, and of what each has beyond the one
/// before: so many, and more where only some of them are.
constexpr uint32_t points_per_ring = 8, points_per_cut_ring = 32;
/// Disks disagree where the squared differences of their lights are so many times their variance.
constexpr double tolerated = 2.5;
/// The light of a disk, and its variance, are known from this many directions on.
constexpr double least_directions = 12;
/// Kinds of light with a smaller share don't count.
constexpr double least_share = 0.05;
/// What merges at a vertex costs time: more than so many per pass are not worth theirs.
constexpr double most_vertices = 600;

double level_radius(const PixelProbe& probe, int level) {
  return double(probe.pixel_width) * std::exp2(0.5 * level);
}

constexpr auto levels = size_t(RadiusLearning::level_count);

RadiusLearning::Disagreement::Pairs disagreement_of(const RadiusLearning::KindSums& sums,
                                                    const std::array<float, levels>& coverage) {
  RadiusLearning::Disagreement::Pairs result{};
  // Where next to nothing has arrived, a single vertex more would do.
  const double of_one =
      sums.light[levels - 1] > 0 ? sums.squares[levels - 1] / sums.light[levels - 1] : 0.0;
  std::array<double, levels> area{};
  for (size_t i = 0; i < levels; ++i)
    area[i] = std::exp2(double(i)) * std::max(0.05, double(coverage[i]));
  for (size_t i = 1; i < levels; ++i)
    for (size_t j = 0; j < i; ++j) {
      if (sqr(sums.light[j]) < least_directions * sums.squares[j]) continue;
      const double difference = sums.light[i] / area[i] - sums.light[j] / area[j];
      // Both hold what lies in the smaller one.
      const double variance =
          std::max(sums.squares[j], of_one * of_one) * sqr(1 / area[j] - 1 / area[i]) +
          (sums.squares[i] - sums.squares[j]) * sqr(1 / area[i]);
      result[i][j] = variance > 0 ? float(sqr(difference) / variance) : 0.0f;
    }
  return result;
}

RadiusLearning::Disagreement disagreement_of(const RadiusLearning::Sums& sums,
                                             const std::array<float, levels>& coverage) {
  double all = 0;
  for (const auto& kind : sums.of) all += kind.light[levels - 1];
  RadiusLearning::Disagreement result;
  for (size_t k = 0; k < RadiusLearning::kind_count; ++k)
    if (sums.of[k].light[levels - 1] > least_share * all)
      result.of[k] = disagreement_of(sums.of[k], coverage);
  return result;
}

/// Shares of the disks that are covered, ring by ring: each disk has twice the area of the one
/// before.
std::array<float, levels> coverage_of(const Scene& scene, const PixelProbe& probe, size_t number,
                                      uint64_t& rays) {
  const MergeDisk widest(probe.vertex, float(level_radius(probe, int(levels) - 1)));
  const DiskCoverage coverage(scene, widest, rays);
  std::array<float, levels> result{};
  double covered = 0, area = 0;  // areas of the first disk
  for (size_t level = 0; level < levels; ++level) {
    const double inner = area;
    area = std::exp2(double(level));
    uint32_t held = 0, count = 0;
    for (uint32_t wanted = points_per_ring; count < wanted; ++count) {
      Sampler sampler =
          Sampler::at(0, uint32_t(level), Stream::training, coverage_element + number, count);
      const Vec2f u = sampler.next_2d();
      const double distance = level_radius(probe, 0) * std::sqrt(inner + (area - inner) * u.x);
      if (coverage.holds(float(level_radius(probe, int(level))), float(distance), 2 * pi * u.y))
        ++held;
      if (count + 1 == points_per_ring && held > 0 && held < points_per_ring)
        wanted = points_per_cut_ring;
    }
    covered += (area - inner) * held / count;
    result[level] = float(covered / area);
  }
  return result;
}

}  // namespace

RadiusLearning::RadiusLearning(const Scene& scene, const PixelPlans& first, uint64_t& rays,
                               const std::stop_token& stop)
    : coverage_(first.probes().size()) {
  std::atomic<uint64_t> counted{0};
  parallel_blocks(coverage_.size(), 16, [&](size_t begin, size_t end, size_t) {
    uint64_t block_rays = 0;
    for (size_t p = begin; p < end && !stop.stop_requested(); ++p)
      if (first.probes()[p].found)
        coverage_[p] = coverage_of(scene, first.probes()[p], p, block_rays);
    counted += block_rays;
  });
  rays += counted;
}

std::vector<RadiusLearning::Sums> RadiusLearning::sums_of(const PixelPlans& first,
                                                          const LightVertices& light,
                                                          ComponentSet wanted) {
  std::vector<Sums> result(first.probes().size());
  if (light.tree.empty()) return result;
  parallel_blocks(result.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t p = begin; p < end; ++p) {
      const PixelProbe& probe = first.probes()[p];
      if (!probe.found || !(probe.pixel_width > 0)) continue;
      const double least_sq = sqr(level_radius(probe, 0));
      const auto widest = float(level_radius(probe, level_count - 1));
      const MergeDisk disk(probe.vertex, widest);
      Sums& sums = result[p];
      light.tree.within(
          probe.vertex.position(), disk.side(), false, sqr(widest), [&](uint32_t index, float) {
            const LightVertexData& photon = light.tree.tree().data(index);
            const Vec3f offset = light.tree.tree().key(index) - probe.vertex.position();
            if (!disk.counts(offset, photon.side)) return;
            const double reach_sq = double(disk.least_radius_sq(offset));
            size_t level = 0;
            for (double limit = least_sq; reach_sq > limit; limit *= 2) ++level;
            if (level >= levels) return;
            sums.vertices[level] += 1;
            const auto value = double(probe.sent(photon, wanted).sum());
            auto& kind = sums.of[photon.specular ? 0 : 1];
            kind.light[level] += value;
            kind.squares[level] += value * value;
          });
      for (size_t level = 1; level < levels; ++level)
        sums.vertices[level] += sums.vertices[level - 1];
      for (auto& kind : sums.of)
        for (size_t level = 1; level < levels; ++level) {
          kind.light[level] += kind.light[level - 1];
          kind.squares[level] += kind.squares[level - 1];
        }
    }
  });
  return result;
}

/// The widest disk that agrees with all smaller ones, by the mean over the probes around: a single
/// one's noise would choose among its levels by chance.
int RadiusLearning::widest_level(const std::vector<Disagreement>& disagreements,
                                 const PixelPlans& first, size_t probe) const {
  const Vec2i size = first.blocks();
  const Vec2i at(int(probe % size_t(size.x)), int(probe / size_t(size.x)));
  Disagreement sum;
  int count = 0;
  for (int y = std::max(0, at.y - 1); y <= std::min(size.y - 1, at.y + 1); ++y)
    for (int x = std::max(0, at.x - 1); x <= std::min(size.x - 1, at.x + 1); ++x) {
      const size_t i = size_t(y) * size_t(size.x) + size_t(x);
      if (!first.probes()[i].found) continue;
      ++count;
      for (size_t k = 0; k < kind_count; ++k)
        for (size_t level = 1; level < levels; ++level)
          for (size_t smaller = 0; smaller < level; ++smaller)
            sum.of[k][level][smaller] += disagreements[i].of[k][level][smaller];
    }
  for (size_t level = 1; level < levels; ++level)
    for (size_t smaller = 0; smaller < level; ++smaller)
      for (const auto& kind : sum.of)
        if (double(kind[level][smaller]) > tolerated * count) return int(level) - 1;
  return int(levels) - 1;
}

std::vector<PixelPlan> RadiusLearning::plans(const PixelPlans& first, const std::vector<Sums>& sums,
                                             uint32_t passes, float shrinkage) const {
  std::vector<PixelPlan> result = first.plans();
  std::vector<Disagreement> disagreements(sums.size());
  for (size_t p = 0; p < sums.size(); ++p)
    disagreements[p] = disagreement_of(sums[p], coverage_[p]);
  for (size_t p = 0; p < sums.size(); ++p) {
    const PixelProbe& probe = first.probes()[p];
    if (!probe.found) continue;
    int level = widest_level(disagreements, first, p);
    while (level > 0 && sums[p].vertices[size_t(level)] > most_vertices * passes) --level;
    result[p].merge_area = float(pi * sqr(level_radius(probe, level))) / shrinkage;
  }
  return result;
}

}  // namespace kaustik
