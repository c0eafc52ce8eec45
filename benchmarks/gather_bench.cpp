// What lies within a radius: the kd-tree of buckets against a sorted hash grid, the usual structure
// for merging, with the same loop over 16 points at a time. Ratios of medians of interleaved runs,
// in processor time of one thread; for disks of a given size, and for those of the first pass of
// `ppm` on scenes that ship, whose size is printed.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/photon/coverage/merge_disk.h"
#include "kaustik/transport/camera_walk.h"
#include "kaustik/vcm/light_pass.h"
#include "kaustik/vcm/plan/plans.h"

namespace {

using namespace kaustik;

constexpr size_t lanes = KdBuckets::bucket_size;
/// On each of three sides: about as many queries for each point as a pass of `auto` has.
constexpr int queries_per_side = 512;
constexpr int repeats = 5;

/// Σ 1 − distance²/radius² by lane, so that the compiler may use vectors without reordering sums.
struct Sum {
  float of[lanes] = {};
  double total() const { return std::accumulate(of, of + lanes, 0.0); }
};

#if defined(__x86_64__) && defined(__linux__)
__attribute__((target_clones("avx2", "default")))
#endif
void add_16(const float* x, const float* y, const float* z, const Vec3f& at, float radius_sq,
            Sum& sum) {
  for (size_t i = 0; i < lanes; ++i) {
    const float dx = x[i] - at.x, dy = y[i] - at.y, dz = z[i] - at.z;
    const float kernel = 1 - (dx * dx + dy * dy + dz * dz) / radius_sq;
    sum.of[i] += kernel > 0 ? kernel : 0;
  }
}

/// Points sorted by the hash of their cell, as wide as the largest diameter that is asked for.
class HashGrid {
 public:
  HashGrid(const std::vector<Vec3f>& points, float largest_radius)
      : per_cell_(0.5f / largest_radius), mask_(std::bit_ceil(points.size()) - 1) {
    begins_.assign(mask_ + 2, 0);
    std::vector<uint32_t> slots;
    slots.reserve(points.size());
    for (const Vec3f& p : points) {
      slots.push_back(uint32_t(slot(cell(p.x), cell(p.y), cell(p.z))));
      ++begins_[slots.back() + 1];
    }
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    std::vector<uint32_t> next(begins_.begin(), begins_.end() - 1);
    for (auto* axis : {&x_, &y_, &z_}) axis->resize(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
      const uint32_t to = next[slots[i]]++;
      x_[to] = points[i].x, y_[to] = points[i].y, z_[to] = points[i].z;
    }
  }

  void add(const Vec3f& at, float radius, Sum& sum) const {
    size_t seen[8];
    size_t count = 0;
    const auto low = [&](float v) { return cell(v - 0.5f / per_cell_); };
    for (int i = 0; i < 8; ++i) {
      const size_t s = slot(low(at.x) + (i & 1), low(at.y) + (i >> 1 & 1), low(at.z) + (i >> 2));
      if (std::find(seen, seen + count, s) != seen + count) continue;
      seen[count++] = s;
      // The last ones of a cell are followed by those of others.
      size_t p = begins_[s];
      for (; p + lanes <= begins_[s + 1]; p += lanes)
        add_16(&x_[p], &y_[p], &z_[p], at, sqr(radius), sum);
      for (; p < begins_[s + 1]; ++p) {
        const float share = length_sq(Vec3f(x_[p], y_[p], z_[p]) - at) / sqr(radius);
        sum.of[p % lanes] += std::max(0.0f, 1 - share);
      }
    }
  }

 private:
  int cell(float v) const { return int(std::floor(v * per_cell_)); }
  size_t slot(int x, int y, int z) const {
    return (uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u ^ uint32_t(z) * 83492791u) & mask_;
  }

  float per_cell_;
  size_t mask_;
  std::vector<uint32_t> begins_;
  std::vector<float> x_, y_, z_;
};

struct Query {
  Vec3f at;
  float radius;
};

struct Case {
  std::string name;
  std::vector<Vec3f> points;
  std::vector<Query> queries;
};

/// Points on the six sides of a cube, looked at row by row, with so many in a disk on average; or
/// in disks of an eighth of that radius up to it, as merging has them that learns them.
Case room(size_t count, double per_disk, bool uneven) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  const auto on_side = [](size_t side, float u, float v) {
    const float w = side % 2 == 0 ? 0.0f : 1.0f;
    return side < 2 ? Vec3f(u, v, w) : side < 4 ? Vec3f(v, w, u) : Vec3f(w, u, v);
  };
  Case result;
  result.name = fmt::format("gather_{:.0f}{}", per_disk, uneven ? "_uneven" : "");
  for (size_t i = 0; i < count; ++i)
    result.points.push_back(on_side(random() % 6, unit(random), unit(random)));
  const auto radius = float(std::sqrt(6 * per_disk / double(count) / std::numbers::pi));
  for (size_t side = 0; side < 6; side += 2)
    for (int y = 0; y < queries_per_side; ++y)
      for (int x = 0; x < queries_per_side; ++x) {
        // Blocks of 32 × 32 queries have one radius.
        const float share = uneven ? std::exp2(-float((x / 32 * 7 + y / 32 * 3) % 7) / 2) : 1.0f;
        result.queries.push_back({on_side(side, (float(x) + 0.5f) / queries_per_side,
                                          (float(y) + 0.5f) / queries_per_side),
                                  share * radius});
      }
  return result;
}

/// A pass of `ppm` before anything but its pilots has been learned.
struct FirstPass {
  VcmPlans plans;
  LightVertices light;
};

FirstPass first_pass(const Scene& scene) {
  Problems problems;
  const VcmSettings settings(Arguments(ppm_info(), {}, {}, problems));
  const auto plain = std::make_shared<const LightPathEmission>(scene, settings.aim);
  const uint32_t samples = settings.samples_per_pass;
  FirstPass pass;
  pass.plans = *VcmPlanner(scene, settings, plain).make(samples, {}).plans;
  PathWeights::Settings weights;
  weights.techniques = pass.plans.techniques;
  SplatBuffer nowhere = SplatBuffer::nowhere();
  PassReport report;
  pass.light = trace_light_vertices(
      {.scene = scene,
       .emission = *pass.plans.guides.emission,
       .weights = PathWeights(weights),
       .components = settings.components,
       .maximum_events = settings.maximum_events,
       .light_paths = light_path_count(scene.film().crop_size, samples, pass.plans.light_paths),
       .camera_samples = float(samples),
       .plans = pass.plans.pixels,
       .media = pass.plans.media,
       .scattering = pass.plans.guides.scattering.get()},
      {1, 0, samples}, Stream::light_path, nowhere, {}, {}, report);
  return pass;
}

/// The first vertex, behind mirrors and clear glass, that light merges with; false: there is none.
bool go_to_merging(CameraWalk& walk, Sampler& sampler) {
  constexpr int most_events = 16;
  while (walk.events() < most_events && walk.advance()) {
    if (any(walk.vertex().lobes() & (Lobes::diffuse | Lobes::glossy))) return true;
    const Vec2f u = sampler.next_2d(), u_choice = sampler.next_2d();
    if (!walk.scatter(Lobes::all, 1, u_choice.x, u)) return false;
  }
  return false;
}

/// Radius of its disk, as a pass chooses it.
float merge_radius(const Scene& scene, const VcmPlans& plans, CameraWalk& walk) {
  const float widest =
      std::sqrt(plans.pixels.at(walk.raster(), 1).merge_area / std::numbers::pi_v<float>);
  const DiskCoverage covered(scene, MergeDisk(walk.vertex(), widest), walk.rays());
  return std::min(widest, std::max(covered.clear_radius(), walk.footprint().width));
}

/// Mean, and shares of the disks that hold no more.
void report_sizes(const std::string& name, std::vector<double> counts) {
  std::sort(counts.begin(), counts.end());
  const auto at = [&](double share) { return counts[size_t(share * double(counts.size() - 1))]; };
  bench::report("disks_of_" + name,
                std::accumulate(counts.begin(), counts.end(), 0.0) / double(counts.size()),
                "vertices of light paths that merge in a disk of the first pass of ppm, on average",
                fmt::format("{} disks; a tenth of them hold up to {:.0f}, a half {:.0f}, nine "
                            "tenths {:.0f}, all {:.0f}",
                            counts.size(), at(0.1), at(0.5), at(0.9), at(1)));
}

/// The disks of one camera sample per pixel, tile by tile as they are rendered, among the vertices
/// of the pass's light paths.
Case rendered(const std::string& name) {
  const auto scene = build_scene(bench::load_shipped(name));
  const FirstPass pass = first_pass(*scene);
  Case result;
  result.name = "gather_" + name;
  const auto& tree = pass.light.tree.tree();
  for (uint32_t i = 0; i < tree.size(); ++i) result.points.push_back(tree.key(i));
  // Not in the tree's own order.
  std::shuffle(result.points.begin(), result.points.end(), std::mt19937(1));
  constexpr int tile = 16;
  const Vec2i size = scene->film().crop_size;
  std::vector<double> counts;
  const auto look = [&](int x, int y) {
    Sampler sampler =
        Sampler::at(1, 0, Stream::camera, uint64_t(y) * uint64_t(size.x) + uint64_t(x), 0);
    SampleSink sink(ComponentSet::all());
    CameraWalk walk(*scene, {float(x) + 0.5f, float(y) + 0.5f}, sampler, sink);
    if (!go_to_merging(walk, sampler)) return;
    const float radius = merge_radius(*scene, pass.plans, walk);
    if (!(radius > 0)) return;
    const SurfaceVertex& vertex = walk.vertex();
    const MergeDisk disk(vertex, radius);
    result.queries.push_back({vertex.position(), radius});
    double count = 0;
    pass.light.tree.within(vertex.position(), disk.both_sides() ? vertex.point().ng : disk.side(),
                           disk.both_sides(), sqr(radius), [&](uint32_t, float) { ++count; });
    counts.push_back(count);
  };
  for (int y0 = 0; y0 < size.y; y0 += tile)
    for (int x0 = 0; x0 < size.x; x0 += tile)
      for (int y = y0; y < std::min(y0 + tile, size.y); ++y)
        for (int x = x0; x < std::min(x0 + tile, size.x); ++x) look(x, y);
  report_sizes(name, counts);
  return result;
}

double cpu_seconds_of(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

void measure(const Case& one) {
  float largest = 0;
  for (const Query& query : one.queries) largest = std::max(largest, query.radius);
  KdBuckets tree;
  std::optional<HashGrid> grid;
  std::vector<double> tree_builds, grid_builds, tree_searches, grid_searches;
  double by_tree = 0, by_grid = 0;
  for (int i = 0; i < repeats; ++i) {
    tree_builds.push_back(cpu_seconds_of([&] { tree.build(one.points); }));
    grid_builds.push_back(cpu_seconds_of([&] { grid.emplace(one.points, largest); }));
    tree_searches.push_back(cpu_seconds_of([&] {
      by_tree = 0;
      for (const Query& query : one.queries) {
        Sum sum;
        const auto take = [&](uint32_t number) {
          const KdBuckets::Bucket& bucket = tree.bucket(number);
          add_16(bucket.x, bucket.y, bucket.z, query.at, sqr(query.radius), sum);
        };
        KdBuckets::BucketSink sink;
        sink.take = [](void* context, const uint32_t* numbers, size_t count) {
          for (size_t k = 0; k < count; ++k)
            (*static_cast<const decltype(take)*>(context))(numbers[k]);
        };
        sink.context = const_cast<void*>(static_cast<const void*>(&take));
        tree.overlapping(query.at, sqr(query.radius), sink);
        by_tree += sum.total();
      }
    }));
    grid_searches.push_back(cpu_seconds_of([&] {
      by_grid = 0;
      for (const Query& query : one.queries) {
        Sum sum;
        grid->add(query.at, query.radius, sum);
        by_grid += sum.total();
      }
    }));
  }
  if (!(std::fabs(by_tree - by_grid) < 1e-4 * by_tree)) {
    fmt::print(stderr, "gather_bench: {} by the tree, {} by the grid\n", by_tree, by_grid);
    std::exit(1);
  }
  const double tree_search = bench::median(tree_searches), tree_build = bench::median(tree_builds);
  const double grid_search = bench::median(grid_searches), grid_build = bench::median(grid_builds);
  const auto count = double(one.queries.size());
  bench::report(one.name, grid_search / tree_search, "ratio of times, hash grid over kd-tree",
                fmt::format("{} points; a query takes the grid {:.2f} us, the tree {:.2f} us; "
                            "building takes {:.0f} ms and {:.0f} ms; with both, {:.2f}",
                            one.points.size(), 1e6 * grid_search / count, 1e6 * tree_search / count,
                            1e3 * grid_build, 1e3 * tree_build,
                            (grid_search + grid_build) / (tree_search + tree_build)));
}

}  // namespace

int main() {
  using namespace kaustik;
  try {
    with_threads(1, [] {
      for (const double per_disk : {10.0, 30.0, 300.0})
        for (const bool uneven : {false, true}) measure(room(500'000, per_disk, uneven));
    });
    for (const char* scene : {"cornell_spheres", "metal_ring"}) {
      const Case one = rendered(scene);
      with_threads(1, [&] { measure(one); });
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
