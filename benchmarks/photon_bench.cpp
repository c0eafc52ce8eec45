// What a photon costs: memory, and a radiance estimate beside the bare search of the tree.
#include <ctime>
#include <random>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"

namespace {

using namespace kaustik;

constexpr int neighbors = 50;
constexpr size_t query_count = 50000;
constexpr int repeats = 9;

double cpu_seconds_of(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

void measure_estimate(const PhotonMap& map) {
  std::mt19937 random(3);
  std::normal_distribution<float> jitter(0, 2e-4f);
  std::vector<std::pair<Vec3f, Vec3f>> queries;
  for (size_t i = 0; i < query_count; ++i) {
    const auto index = uint32_t(random() % map.size());
    queries.emplace_back(map.tree().key(index) + Vec3f(jitter(random), jitter(random), 0),
                         map.tree().data(index).side.unpack());
  }
  EstimateSettings settings;
  settings.neighbors = neighbors;
  settings.kernel = Kernel::cone;
  KdTree<3, Vec3f, Photon>::Neighbors found;
  double sum = 0;
  std::vector<double> searches, estimates;
  for (int i = 0; i < repeats; ++i) {
    searches.push_back(cpu_seconds_of([&] {
      for (const auto& [position, side] : queries) {
        map.tree().nearest(position, neighbors, infinity, KdAcceptAll(), found);
        sum += double(found.farthest_sq());
      }
    }));
    estimates.push_back(cpu_seconds_of([&] {
      for (const auto& [position, side] : queries)
        sum += double(map.irradiance(position, side, settings).value.sum());
    }));
  }
  const double search = bench::median(searches), estimate = bench::median(estimates);
  bench::report(
      "estimate_vs_search", estimate / search, "ratio of times (lower is better)",
      fmt::format("bare search for {} photons: {:.2f} us, estimate {:.2f} us (checksum "
                  "{:.3g})",
                  neighbors, 1e6 * search / query_count, 1e6 * estimate / query_count, sum));
}

}  // namespace

int main() {
  const PhotonMap map = bench::ring_caustic(1000000);
  bench::report("bytes_per_photon", double(map.size_in_bytes()) / double(map.size()), "bytes",
                "4 lanes of flux (16), position (12), direction, distance, side, tree");
  bench::report("kdtree_build_temporary_bytes_per_photon",
                double(sizeof(Vec3f) + sizeof(Photon) + sizeof(uint32_t)), "bytes",
                "input arrays and order, freed when the build ends");
  measure_estimate(map);
  return 0;
}
