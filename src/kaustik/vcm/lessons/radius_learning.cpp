#include "kaustik/vcm/lessons/radius_learning.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numbers>

#include "kaustik/base/parallel.h"
#include "kaustik/base/sampler.h"
#include "kaustik/photon/coverage/merge_disk.h"
#include "kaustik/vcm/lessons/probe_light.h"

namespace kaustik {
namespace {

/// Points that tell how much is covered of the smallest disk, and of what each has beyond the one
/// before: so many, and more where only some of them are.
constexpr uint32_t points_per_ring = 8, points_per_cut_ring = 32;
/// Points that are looked for: edges may leave little of a ring.
constexpr uint32_t most_points = 256;
/// Disks disagree where the squared differences of their lights are so many times their variance.
constexpr double tolerated = 2.5;
/// The light of a disk, and its variance, are known from this many directions on.
constexpr double least_directions = 12;
/// A kind of light with a smaller share of both disks doesn't count. (Of the widest one alone a
/// line of light is little, and was blurred by what little else there was to see.)
constexpr double least_share = 0.05;
/// Disks of which edges leave less tell nothing of those that the block's other vertices have.
constexpr double least_left = 0.125;
/// Of a disk, at least: coverage is an estimate, and most of nothing is not to be nothing.
constexpr float least_covered = 0.05f;
/// Slopes that change the scale of a kernel by less than that are none.
constexpr double least_slope = 1e-3;
/// Slopes take off the square of a bias and add a variance. Where the squared difference that they
/// make is more than so many times its variance, the first is more than the second.
constexpr double worth_slopes = 2;
/// What merges at a vertex costs time: more than so many per pass are not worth theirs.
constexpr double most_vertices = 600;
/// Disks with so many times more are not looked at any longer, but for the first: disks around tell
/// of one another, and later passes may have fewer.
constexpr double hopeless = 2;

double level_radius(const PixelProbe& probe, int level) {
  return double(probe.pixel_width) * std::exp2(0.5 * level);
}

/// Areas of disks, in pixels, as geometric means of those around a probe, near ones twice: seams
/// show where one block's disks are many times as wide as the next one's.
std::vector<PixelPlan> smoothed(const PixelPlans& at, const std::vector<PixelPlan>& plans) {
  const std::vector<PixelProbe>& probes = at.seen().probes();
  const BlockGrid& grid = at.seen().grid();
  const auto is_known = [&](size_t i) {
    return probes[i].found && probes[i].pixel_width > 0 && plans[i].merge_area > 0;
  };
  std::vector<PixelPlan> result = plans;
  for (size_t own = 0; own < plans.size(); ++own) {
    if (!is_known(own)) continue;
    double log_radii = 0, weights = 0;
    grid.visit_around(own, [&](size_t i) {
      if (!is_known(i)) return;
      const Vec2i away = grid.block(i) - grid.block(own);
      const double weight = (away.x == 0 ? 2 : 1) * (away.y == 0 ? 2 : 1);
      log_radii +=
          weight * std::log(std::sqrt(double(plans[i].merge_area)) / double(probes[i].pixel_width));
      weights += weight;
    });
    const double widths = std::exp(log_radii / weights);
    result[own].merge_area = float(sqr(widths * double(probes[own].pixel_width)));
  }
  return result;
}

constexpr size_t probes_per_block = 256;
constexpr auto levels = size_t(RadiusLearning::level_count);

/// The light vertices within the widest disk of a probe, by the smallest disk that they are in,
/// bucket by bucket of their tree.
class RingSearch {
 public:
  /// `light`, `at_probe` and the vertex of `widest` must outlive this. `width`: radius of the
  /// smallest of `count` disks.
  RingSearch(const LightVertices& light, const ProbeLight& at_probe, const MergeDisk& widest,
             const DiskEdges& edges, float width, size_t count)
      : tree_(light.tree.tree()),
        at_probe_(at_probe),
        disk_(widest),
        frame_(widest.side()),
        center_(widest.vertex().position()),
        edges_(edges),
        inverse_least_sq_(1 / sqr(width)),
        limit_(std::exp2(float(count - 1))),
        count_(count) {}

  void add_to(RadiusLearning::Sums& sums) {
    const auto take = [](void* context, const uint32_t* numbers, size_t count) {
      auto& search = *static_cast<RingSearch*>(context);
      for (size_t i = 0; i < count; ++i) search.take_bucket(numbers[i]);
    };
    tree_.buckets().overlapping(center_, sqr(disk_.radius()), {take, this});
    double vertices = 0;
    for (size_t level = 0; level < count_; ++level)
      sums.vertices[level] = vertices += vertices_[level];
    for (size_t kind = 0; kind < of_.size(); ++kind) {
      Ring sum;
      for (size_t level = 0; level < count_; ++level) {
        sum.add(of_[kind][level]);
        auto& to = sums.of[kind];
        to.light[level] = sum.light;
        to.squares[level] = sum.squares;
        to.x[level] = sum.x;
        to.y[level] = sum.y;
      }
    }
  }

 private:
  static constexpr size_t bucket_size = KdBuckets::bucket_size;
  /// RadiusLearning::KindSums of a ring.
  struct Ring {
    double light = 0, squares = 0, x = 0, y = 0;
    void add(const Ring& other) {
      light += other.light;
      squares += other.squares;
      x += other.x;
      y += other.y;
    }
  };

  void take_bucket(uint32_t number) {
    const KdBuckets::Bucket& points = tree_.buckets().bucket(number);
    const Vec3f n = frame_.z;
    const float deepest = disk_.flatness();
    // Square of the radius of the smallest disk in which a point counts, over that of the least
    // disk. What does not count at all is beyond the limit, as are places that hold no point.
    float reach[bucket_size];
    for (size_t i = 0; i < bucket_size; ++i) {
      const float x = points.x[i] - center_.x, y = points.y[i] - center_.y,
                  z = points.z[i] - center_.z;
      const float height = std::fabs(n.x * x + n.y * y + n.z * z);
      const float by_height = sqr(height * MergeDisk::inverse_flatness());
      const float distance_sq = x * x + y * y + z * z;
      reach[i] = (by_height > distance_sq ? by_height : distance_sq) * inverse_least_sq_;
      if (!(height <= deepest)) reach[i] = infinity;
    }
    for (size_t i = 0; i < bucket_size; ++i)
      if (reach[i] <= limit_)
        take(uint32_t(number * bucket_size + i), {points.x[i], points.y[i], points.z[i]}, reach[i]);
  }

  void take(uint32_t index, const Vec3f& position, float reach) {
    const LightVertexData& photon = tree_.data(index);
    const float cosine = photon.side.dot(frame_.z) / photon.side.length();
    if (!(cosine > MergeDisk::least_cosine())) return;
    const size_t level = level_of(reach);
    // The block's other vertices may have no edges.
    vertices_[level] += 1;
    const Vec3f offset = position - center_;
    if (!edges_.hold(offset)) return;
    const float value = at_probe_.sent(photon) * std::min(cosine, 1.0f);
    const auto light = double(value);
    of_[photon.specular ? 0 : 1][level].add({light, light * light,
                                             light * double(dot(offset, frame_.x)),
                                             light * double(dot(offset, frame_.y))});
  }

  /// The logarithm to base 2, rounded up; at least 0.
  static size_t level_of(float reach) {
    const int exponent = int((std::bit_cast<uint32_t>(reach) + 0x7fffff) >> 23) - 127;
    return size_t(std::max(0, exponent));
  }

  const SidedTree<LightVertexData>::Tree& tree_;
  const ProbeLight& at_probe_;
  const MergeDisk disk_;
  const Frame frame_;
  const Vec3f center_;
  const DiskEdges edges_;
  const float inverse_least_sq_, limit_;
  const size_t count_;
  std::array<double, levels> vertices_{};
  std::array<std::array<Ring, levels>, RadiusLearning::kind_count> of_{};
};

}  // namespace

/// Of the `count` smallest disks.
RadiusLearning::Disagreement::Pairs RadiusLearning::disagreement_of(const KindSums& sums,
                                                                    size_t count,
                                                                    const Levels& of) {
  Disagreement::Pairs result{};
  // Where next to nothing has arrived, a single vertex more would do.
  const double of_one =
      sums.light[count - 1] > 0 ? sums.squares[count - 1] / sums.light[count - 1] : 0.0;
  std::array<double, levels> area{}, share{}, light{};
  for (size_t i = 0; i < count; ++i) {
    const Level& level = of[i];
    area[i] = level.moments.one * sqr(level.radius);
    share[i] = std::max(0.05, level.share);
    light[i] = (sums.light[i] + level.slope_x * sums.x[i] + level.slope_y * sums.y[i]) *
               level.scale / share[i];
  }
  for (size_t i = 1; i < count; ++i)
    for (size_t j = 0; j < i; ++j) {
      if (sqr(sums.light[j]) < least_directions * sums.squares[j]) continue;
      if (!(area[i] > area[j])) continue;
      // ∫ of the squared factor of the wide disk over the narrow one; over its own disk that is its
      // scale, and so is that of the product with the factor of the narrow one over that.
      const DiskMoments& m = of[j].moments;
      const double x = of[i].slope_x * of[j].radius, y = of[i].slope_y * of[j].radius;
      const double within =
          sqr(of[i].scale * of[j].radius) *
          (m.one + 2 * (x * m.x + y * m.y) + x * x * m.xx + 2 * x * y * m.xy + y * y * m.yy);
      const double inside = std::max(sums.squares[j], of_one * of_one) / area[j];
      const double outside = (sums.squares[i] - sums.squares[j]) / (area[i] - area[j]);
      const double variance = inside * std::max(0.0, of[j].scale / sqr(share[j]) -
                                                         2 * of[i].scale / (share[i] * share[j]) +
                                                         within / sqr(share[i])) +
                              outside * std::max(0.0, of[i].scale - within) / sqr(share[i]);
      result[i][j] = variance > 0 ? float(sqr(light[i] - light[j]) / variance) : 0.0f;
    }
  return result;
}

RadiusLearning::Disagreement RadiusLearning::disagreement_of(const Sums& sums, const Levels& of) {
  std::array<double, levels> all{};
  for (const KindSums& kind : sums.of)
    for (size_t i = 0; i < levels; ++i) all[i] += kind.light[i];
  Disagreement result;
  for (size_t k = 0; k < kind_count; ++k) {
    const auto counts = [&](size_t i) { return sums.of[k].light[i] > least_share * all[i]; };
    Disagreement::Pairs& pairs = result.of[k] = disagreement_of(sums.of[k], sums.levels, of);
    for (size_t i = 1; i < levels; ++i)
      for (size_t j = 0; j < i; ++j)
        if (!counts(i) && !counts(j)) pairs[i][j] = 0;
  }
  return result;
}

/// Ring by ring: each disk has twice the area of the one before.
RadiusLearning::Levels RadiusLearning::levels_of(const Scene& scene, const PixelProbe& probe,
                                                 const PixelPlans& first, size_t number,
                                                 uint64_t& rays) {
  const MergeDisk widest(probe.vertex, float(level_radius(probe, int(levels) - 1)));
  const DiskCoverage coverage(scene, widest, rays);
  const Frame frame(widest.side());
  const DiskEdges edges = first.seen().disk_bounds(number, widest.radius()).edges;
  Levels result;
  double covered = 0, area = 0;  // of what edges leave, m²
  for (size_t i = 0; i < levels; ++i) {
    Level& level = result[i];
    level.radius = level_radius(probe, int(i));
    const auto radius = float(level.radius);
    level.moments = disk_moments(frame, radius, edges, KernelShape::flat);
    DiskKernel kernel(frame, radius, edges, KernelShape::flat);
    const DiskBounds bounds = first.seen().disk_bounds(number, radius);
    if (!bounds.are_complete) kernel.level();
    const bool is_all_covered = bounds.are_complete && bounds.are_clear();
    level.scale = double(kernel.scale);
    level.slope_x = double(dot(kernel.slope, frame.x));
    level.slope_y = double(dot(kernel.slope, frame.y));
    const double inner_sq = i == 0 ? 0 : sqr(result[i - 1].radius);
    uint32_t held = 0, count = 0, points = 0;
    for (uint32_t wanted = points_per_ring; count < wanted && points < most_points; ++points) {
      Sampler sampler = Sampler::at(0, uint32_t(i), Stream::disk_cover, number, points);
      const Vec2f u = sampler.next_2d();
      const auto distance =
          float(std::sqrt(inner_sq + (sqr(level.radius) - inner_sq) * double(u.x)));
      const float angle = 2 * pi * u.y;
      if (!edges.hold((frame.x * std::cos(angle) + frame.y * std::sin(angle)) * distance)) continue;
      if (is_all_covered || coverage.holds(radius, distance, angle)) ++held;
      if (++count == points_per_ring && held > 0 && held < points_per_ring)
        wanted = points_per_cut_ring;
    }
    const double whole = level.moments.one * sqr(level.radius);
    if (count > 0) covered += (whole - area) * held / count;
    area = whole;
    level.share = area > 0 ? covered / area : 0.0;
  }
  return result;
}

RadiusLearning::RadiusLearning(const Scene& scene, const PixelPlans& first, uint64_t& rays,
                               const std::stop_token& stop)
    : levels_(first.seen().probes().size()) {
  std::atomic<uint64_t> counted{0};
  parallel_blocks(levels_.size(), 16, [&](size_t begin, size_t end, size_t) {
    uint64_t block_rays = 0;
    for (size_t p = begin; p < end && !stop.stop_requested(); ++p)
      if (first.seen().probes()[p].found)
        levels_[p] = levels_of(scene, first.seen().probes()[p], first, p, block_rays);
    counted += block_rays;
  });
  rays += counted;
}

std::vector<RadiusLearning::Sums> RadiusLearning::sums_of(const PixelPlans& first,
                                                          const LightVertices& light,
                                                          ComponentSet wanted,
                                                          const std::vector<Sums>& so_far,
                                                          const std::stop_token& stop) {
  std::vector<Sums> result(first.seen().probes().size());
  if (light.tree.empty()) return result;
  parallel_blocks(result.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t p = begin; p < end && !stop.stop_requested(); ++p) {
      const PixelProbe& probe = first.seen().probes()[p];
      if (!probe.found || !(probe.pixel_width > 0)) continue;
      const size_t count = so_far[p].levels;
      const auto widest = float(level_radius(probe, int(count) - 1));
      const ProbeLight at_probe(probe, wanted, light.wavelengths);
      RingSearch search(light, at_probe, MergeDisk(probe.vertex, widest),
                        first.seen().disk_bounds(p, widest).edges, probe.pixel_width, count);
      search.add_to(result[p]);
    }
  });
  return result;
}

void RadiusLearning::narrow(std::vector<Sums>& sums, uint32_t passes) {
  for (Sums& of : sums) {
    const auto end = of.vertices.begin() + std::ptrdiff_t(of.levels);
    const auto first = std::find_if(of.vertices.begin(), end, [&](double vertices) {
      return vertices > hopeless * most_vertices * passes;
    });
    if (first != end) of.levels = size_t(first - of.vertices.begin()) + 1;
  }
}

/// The widest disk that agrees with all smaller ones, by the mean over the probes around that have
/// it: a single one's noise would choose among its levels by chance.
int RadiusLearning::widest_level(const std::vector<Disagreement>& disagreements,
                                 const std::vector<Sums>& sums, const PixelPlans& first,
                                 size_t probe) const {
  Disagreement sum;
  std::array<int, levels> count{};
  first.seen().grid().visit_around(probe, [&](size_t i) {
    if (!first.seen().probes()[i].found) return;
    for (size_t level = 0; level < sums[i].levels; ++level) ++count[level];
    for (size_t k = 0; k < kind_count; ++k)
      for (size_t level = 1; level < sums[i].levels; ++level)
        for (size_t smaller = 0; smaller < level; ++smaller)
          sum.of[k][level][smaller] += disagreements[i].of[k][level][smaller];
  });
  for (size_t level = 1; level < levels; ++level)
    for (size_t smaller = 0; smaller < level; ++smaller)
      for (const auto& kind : sum.of)
        if (double(kind[level][smaller]) > tolerated * count[level]) return int(level) - 1;
  return int(levels) - 1;
}

/// Where light is even over what is left of the disk the variance of the difference is the density
/// of the squares times ∫ of the square of the factors' difference. Both factors have the integral
/// 1, and the square of each has its own scale, so that is the difference of the scales.
float RadiusLearning::worth_of_slopes(const Sums& sums, const Level& level, size_t number) {
  const double area = level.moments.one * sqr(level.radius);
  if (!(area > 0) || !(level.scale * area > 1 + least_slope)) return -1;
  double difference = 0, squares = 0, light = 0;
  for (const KindSums& kind : sums.of) {
    light += kind.light[number];
    squares += kind.squares[number];
    difference += level.scale * (kind.light[number] + level.slope_x * kind.x[number] +
                                 level.slope_y * kind.y[number]) -
                  kind.light[number] / area;
  }
  if (sqr(light) < least_directions * squares) return -1;
  return float(sqr(difference) / (squares / area * (level.scale - 1 / area)));
}

float RadiusLearning::covered(const Levels& of, float widths) {
  const int nearest = int(std::lround(2 * std::log2(std::max(1.0f, widths))));
  const Level& level = of[size_t(std::min(nearest, level_count - 1))];
  return std::clamp(float(level.moments.one / std::numbers::pi * level.share), least_covered, 1.0f);
}

bool RadiusLearning::are_slopes_worth(const std::vector<Sums>& sums, const PixelPlans& first,
                                      size_t probe, int level) const {
  double sum = 0, count = 0;
  first.seen().grid().visit_around(probe, [&](size_t i) {
    const auto number = size_t(level);
    if (!first.seen().probes()[i].found || number >= sums[i].levels) return;
    const float worth = worth_of_slopes(sums[i], levels_[i][number], number);
    if (!(worth >= 0)) return;
    sum += double(worth);
    ++count;
  });
  return sum > worth_slopes * count;
}

std::vector<PixelPlan> RadiusLearning::plans(const PixelPlans& first, const std::vector<Sums>& sums,
                                             double passes, float shrinkage,
                                             float most_widths) const {
  std::vector<PixelPlan> result = first.plans();
  std::vector<float> most(sums.size(), float(infinity));  // areas
  std::vector<Disagreement> disagreements(sums.size());
  parallel_blocks(sums.size(), probes_per_block, [&](size_t begin, size_t end, size_t) {
    for (size_t p = begin; p < end; ++p) disagreements[p] = disagreement_of(sums[p], levels_[p]);
  });
  parallel_blocks(sums.size(), probes_per_block, [&](size_t begin, size_t end, size_t) {
    for (size_t p = begin; p < end; ++p) {
      const PixelProbe& probe = first.seen().probes()[p];
      if (!probe.found) continue;
      const auto area_of = [&](int level) {
        return float(pi * sqr(level_radius(probe, level))) / shrinkage;
      };
      const auto is_too_wide = [&](size_t i) {
        return std::exp2(0.5f * float(i)) > most_widths || i >= sums[p].levels ||
               sums[p].vertices[i] > most_vertices * passes ||
               levels_[p][i].moments.one < least_left * std::numbers::pi;
      };
      int level = int(levels) - 1;
      while (level > 0 && is_too_wide(size_t(level))) --level;
      most[p] = area_of(level);
      level = std::min(level, widest_level(disagreements, sums, first, p));
      result[p].merge_area = area_of(level);
      result[p].has_slopes = are_slopes_worth(sums, first, p, level) ? 1 : 0;
    }
  });
  result = smoothed(first, result);
  for (size_t p = 0; p < result.size(); ++p) {
    result[p].merge_area = std::min(result[p].merge_area, most[p]);
    const PixelProbe& probe = first.seen().probes()[p];
    if (!probe.found || !(probe.pixel_width > 0)) continue;
    const float radius = std::sqrt(result[p].merge_area * shrinkage * inv_pi);
    result[p].covered = covered(levels_[p], radius / probe.pixel_width);
  }
  return result;
}

}  // namespace kaustik
