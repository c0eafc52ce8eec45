// The kd-tree against nanoflann: k nearest neighbours, and building the tree. Ratios of medians of
// interleaved runs, in processor time where one thread works.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <nanoflann.hpp>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/parallel.h"
#include "kaustik/photon/kd_tree/kd_tree.h"

namespace {

using namespace kaustik;
using bench::median;
using bench::report;
using Tree = KdTree<3, Vec3f, uint32_t>;

constexpr size_t neighbors = 50;
constexpr size_t query_count = 50000;
constexpr int repeats = 9;
/// Trees built in a row for one time of a build.
constexpr size_t builds = 4;

/// Adapter through which nanoflann sees the points.
struct Points {
  const std::vector<Vec3f>& positions;
  size_t kdtree_get_point_count() const { return positions.size(); }
  float kdtree_get_pt(size_t i, size_t axis) const { return positions[i][int(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Peer = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, 3, uint32_t>;

struct Cloud {
  std::vector<Vec3f> points, queries;
};

Cloud uniform_cloud(size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const auto point = [&] { return Vec3f(unit(random), unit(random), unit(random)); };
  Cloud cloud;
  for (size_t i = 0; i < count; ++i) cloud.points.push_back(point());
  for (size_t i = 0; i < query_count; ++i) cloud.queries.push_back(point());
  return cloud;
}

/// The first `count` caustic photons of the metal ring, in an order that says nothing.
std::vector<Vec3f> ring_photons(size_t count) {
  const PhotonMap map = bench::ring_caustic(count);
  std::vector<Vec3f> positions;
  for (uint32_t i = 0; i < map.size(); ++i) positions.push_back(map.tree().key(i));
  std::shuffle(positions.begin(), positions.end(), std::mt19937(2));
  positions.resize(count);
  return positions;
}

/// Queries are where such a cloud is looked at: at its own points, moved a little in their plane.
Cloud photon_cloud(std::vector<Vec3f> photons) {
  std::mt19937 random(3);
  std::normal_distribution<float> jitter(0.0f, 0.0002f);  // m; the ring is 0.1 m wide
  Cloud cloud{std::move(photons), {}};
  for (size_t i = 0; i < query_count; ++i) {
    const Vec3f& near = cloud.points[random() % cloud.points.size()];
    cloud.queries.push_back(near + Vec3f(jitter(random), jitter(random), 0.0f));
  }
  return cloud;
}

double wall_seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Processor time of work that uses one thread: other programs don't count.
double cpu_seconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Median times of two pieces of work, run in turn.
std::pair<double, double> compare(const std::function<double()>& seconds_of_ours,
                                  const std::function<double()>& seconds_of_theirs) {
  std::vector<double> ours, theirs;
  for (int i = 0; i < repeats; ++i) {
    ours.push_back(seconds_of_ours());
    theirs.push_back(seconds_of_theirs());
  }
  return {median(ours), median(theirs)};
}

std::vector<uint32_t> numbers(size_t count) {
  std::vector<uint32_t> result(count);
  std::iota(result.begin(), result.end(), 0u);
  return result;
}

Tree make_tree(const std::vector<Vec3f>& points) {
  Tree tree;
  tree.assign(points, numbers(points.size()));
  return tree;
}

double search_ours(const Tree& tree, const Cloud& cloud) {
  Tree::Neighbors found;
  double sum = 0;
  for (const Vec3f& query : cloud.queries) {
    tree.nearest(query, neighbors, Tree::unlimited, KdAcceptAll(), found);
    sum += double(found.farthest_sq());
  }
  return sum;
}

double search_theirs(const Peer& peer, const Cloud& cloud) {
  uint32_t indices[neighbors];
  float distances_sq[neighbors];
  double sum = 0;
  for (const Vec3f& query : cloud.queries) {
    peer.knnSearch(&query.x, neighbors, indices, distances_sq);
    sum += double(distances_sq[neighbors - 1]);
  }
  return sum;
}

/// Ends the program if the two trees don't find the same distances.
void check_distances(const Tree& tree, const Peer& peer, const Cloud& cloud) {
  Tree::Neighbors found;
  uint32_t indices[neighbors];
  float expected[neighbors];
  for (size_t i = 0; i < cloud.queries.size(); i += 10) {
    const Vec3f& query = cloud.queries[i];
    tree.nearest(query, neighbors, Tree::unlimited, KdAcceptAll(), found);
    peer.knnSearch(&query.x, neighbors, indices, expected);
    std::vector<float> distances(found.distances_sq().begin(), found.distances_sq().end());
    std::sort(distances.begin(), distances.end());
    if (std::equal(distances.begin(), distances.end(), expected, expected + neighbors)) continue;
    fmt::print(stderr, "kd_tree_bench: the trees disagree at query {}\n", i);
    std::exit(1);
  }
}

/// The leaf size at which nanoflann answers these queries in the shortest time.
size_t best_leaf_size(const Cloud& cloud, const Points& points) {
  std::pair<double, size_t> best(infinity, 0);
  for (size_t leaf_size : {8, 12, 16, 24, 32, 48, 64}) {
    Peer peer(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size));
    peer.buildIndex();
    std::vector<double> times;
    for (int i = 0; i < 3; ++i) times.push_back(cpu_seconds([&] { search_theirs(peer, cloud); }));
    best = std::min(best, std::pair(median(times), leaf_size));
  }
  return best.second;
}

size_t measure_search(const std::string& name, const Cloud& cloud) {
  const Tree tree = make_tree(cloud.points);
  const Points points{cloud.points};
  const size_t leaf_size = best_leaf_size(cloud, points);
  Peer peer(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size));
  peer.buildIndex();
  check_distances(tree, peer, cloud);
  double sum = 0;
  const auto [ours, theirs] =
      compare([&] { return cpu_seconds([&] { sum += search_ours(tree, cloud); }); },
              [&] { return cpu_seconds([&] { sum -= search_theirs(peer, cloud); }); });
  if (std::abs(sum) > 1e-6) std::exit(1);
  report(name, theirs / ours, "ratio of queries per second",
         fmt::format("nanoflann, leaf size {}: {:.2f} us per query, ours {:.2f} us", leaf_size,
                     1e6 * theirs / double(query_count), 1e6 * ours / double(query_count)));
  return leaf_size;
}

/// Keeps all threads of this arena busy for a while, so that the system spreads them over the
/// processors: that can take it longer than one tree takes to build.
void wake_threads(int threads) {
  parallel_blocks(size_t(threads), 1, [](size_t, size_t, size_t) {
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(100)) continue;
  });
}

/// Fills trees with `threads` threads; preparing the input isn't timed.
double build_seconds(const std::vector<Vec3f>& points, int threads, const auto& clock) {
  std::vector<std::vector<Vec3f>> keys(builds, points);
  std::vector<std::vector<uint32_t>> data(builds, numbers(points.size()));
  const auto build = [&] {
    Tree tree;
    for (size_t i = 0; i < builds; ++i) tree.assign(std::move(keys[i]), std::move(data[i]));
  };
  double seconds = 0;
  with_threads(threads, [&] {
    wake_threads(threads);
    seconds = clock(build);
  });
  return seconds / double(builds);
}

double peer_build_seconds(const std::vector<Vec3f>& positions, size_t leaf_size) {
  const Points points{positions};
  return cpu_seconds([&] {
    Peer peer(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size));
    peer.buildIndex();
  });
}

void measure_build(const Cloud& cloud, size_t leaf_size) {
  const auto [one, theirs] = compare([&] { return build_seconds(cloud.points, 1, cpu_seconds); },
                                     [&] { return peer_build_seconds(cloud.points, leaf_size); });
  report("kdtree_build_vs_nanoflann", theirs / one, "ratio of speeds, one thread",
         fmt::format("nanoflann, leaf size {}: {:.0f} ms, ours {:.0f} ms", leaf_size, 1e3 * theirs,
                     1e3 * one));
  const auto [single, both] = compare([&] { return build_seconds(cloud.points, 1, wall_seconds); },
                                      [&] { return build_seconds(cloud.points, 2, wall_seconds); });
  report("kdtree_build_2_threads", single / both, "ratio of speeds", "one thread");
}

}  // namespace

int main() {
  constexpr size_t count = 1000000;
  const Cloud uniform = uniform_cloud(count);
  const size_t leaf_size = measure_search("knn50_uniform_vs_nanoflann", uniform);
  measure_search("knn50_caustic_vs_nanoflann", photon_cloud(ring_photons(count)));
  measure_build(uniform, leaf_size);
  const Tree tree = make_tree(uniform.points);
  report("kdtree_bytes_per_point", double(tree.size_in_bytes()) / double(count) - 4.0, "bytes",
         "12 bytes of position");
  return 0;
}
