// The kd-tree against brute force.

#include "kaustik/photon/kd_tree/kd_tree.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <stop_token>
#include <vector>

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr size_t large = 5000;
#else
constexpr size_t large = 50000;
#endif

using Tree = KdTree<3, Vec3f, int>;

/// An item as the brute force sees it; its data is its number.
template <typename Key>
struct Item {
  Key key;
  int data;
};

template <int Dim, typename Key, typename Metric>
std::vector<double> nearest_by_force(const std::vector<Item<Key>>& items, const Key& query,
                                     size_t k, double limit_sq, const Metric& metric,
                                     const auto& accept) {
  std::vector<double> result;
  for (const Item<Key>& item : items) {
    const auto distance_sq = metric(query, item.key);
    if (distance_sq < limit_sq && accept(item.data)) result.push_back(distance_sq);
  }
  std::sort(result.begin(), result.end());
  if (result.size() > k) result.resize(k);
  return result;
}

/// Searches with and without sorting must find what brute force finds, each item once.
template <int Dim, typename Key, typename Metric>
void expect_nearest(const KdTree<Dim, Key, int, Metric>& tree, const std::vector<Item<Key>>& items,
                    const Key& query, size_t k, double limit_sq, const Metric& metric,
                    const auto& accept) {
  using T = KdTree<Dim, Key, int, Metric>;
  const auto limit = typename T::Distance(limit_sq);
  const auto expected = nearest_by_force<Dim>(items, query, k, double(limit), metric, accept);
  typename T::Neighbors found;
  const auto accept_index = [&](uint32_t index) { return accept(tree.data(index)); };
  tree.nearest(query, k, limit, accept_index, found);
  std::vector<double> distances(found.distances_sq().begin(), found.distances_sq().end());
  if (!distances.empty()) {
    EXPECT_EQ(double(found.farthest_sq()), *std::max_element(distances.begin(), distances.end()));
  }
  std::sort(distances.begin(), distances.end());
  EXPECT_EQ(distances, expected);
  EXPECT_EQ(found.complete(), expected.size() == k);
  std::vector<uint32_t> indices(found.indices().begin(), found.indices().end());
  std::sort(indices.begin(), indices.end());
  EXPECT_EQ(std::adjacent_find(indices.begin(), indices.end()), indices.end());
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found.distance_sq(i), metric(query, tree.key(found.index(i))));
    EXPECT_FALSE(tree.removed(found.index(i)));
    EXPECT_TRUE(accept(tree.data(found.index(i))));
  }
  distances.clear();
  for (const auto match : tree.nearest(query, k, limit, accept_index)) {
    distances.push_back(match.distance_sq);
    EXPECT_EQ(match.data, tree.data(match.index));
  }
  EXPECT_EQ(distances, expected);
}

template <int Dim, typename Key, typename Metric>
void expect_regions(const KdTree<Dim, Key, int, Metric>& tree, const std::vector<Item<Key>>& items,
                    const Key& query, double radius_sq, const Metric& metric) {
  using Distance = typename Metric::Distance;
  std::vector<int> expected, expected_in_box, found, found_in_box;
  Key lower = query, upper = query;
  for (int axis = 0; axis < Dim; ++axis) upper[axis] += KdCoordinate<Key>(std::sqrt(radius_sq));
  for (const Item<Key>& item : items) {
    if (metric(query, item.key) < Distance(radius_sq)) expected.push_back(item.data);
    bool inside = true;
    for (int axis = 0; axis < Dim; ++axis)
      inside = inside && item.key[axis] >= lower[axis] && item.key[axis] <= upper[axis];
    if (inside) expected_in_box.push_back(item.data);
  }
  tree.within(query, Distance(radius_sq), [&](uint32_t index, Distance distance_sq) {
    EXPECT_EQ(distance_sq, metric(query, tree.key(index)));
    found.push_back(tree.data(index));
  });
  for (const auto match : tree.range(lower, upper)) found_in_box.push_back(match.data);
  for (auto* list : {&expected, &expected_in_box, &found, &found_in_box})
    std::sort(list->begin(), list->end());
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found_in_box, expected_in_box);
}

/// Everything that can be asked, at a few queries.
template <int Dim, typename Key, typename Metric>
void expect_same_as_force(const KdTree<Dim, Key, int, Metric>& tree,
                          const std::vector<Item<Key>>& items, const std::vector<Key>& queries,
                          const Metric& metric) {
  EXPECT_EQ(tree.size(), items.size());
  const auto all = [](int) { return true; };
  const auto some = [](int data) { return data % 3 == 1; };
  for (const Key& query : queries) {
    const auto everything =
        nearest_by_force<Dim>(items, query, items.size(), infinity, metric, all);
    const double median = everything.empty() ? 1.0 : everything[everything.size() / 2];
    for (size_t k : {size_t(1), size_t(2), size_t(17), size_t(50), size_t(300)}) {
      expect_nearest(tree, items, query, k, infinity, metric, all);
      expect_nearest(tree, items, query, k, infinity, metric, some);
      expect_nearest(tree, items, query, k, 0.1 * median, metric, all);
    }
    expect_nearest(tree, items, query, items.size() + 1, infinity, metric, all);
    expect_nearest(tree, items, query, 0, infinity, metric, all);
    expect_nearest(tree, items, query, 50, 0.0, metric, all);
    expect_nearest(tree, items, query, 100, median, metric, some);
    expect_regions(tree, items, query, median, metric);
    expect_regions(tree, items, query, 0.01 * median, metric);
  }
}

using Points = std::vector<Vec3f>;
using Maker = Vec3f (*)(std::mt19937&);

float unit(std::mt19937& random) { return std::uniform_real_distribution<float>(0, 1)(random); }
Vec3f uniform(std::mt19937& random) {
  const float x = unit(random), y = unit(random);
  return {x, y, unit(random)};
}
Vec3f clustered(std::mt19937& random) {
  const float scale = std::pow(10.0f, -6.0f * unit(random));
  return Vec3f(3.0f, -2.0f, 7.0f) + uniform(random) * scale;
}
Vec3f collinear(std::mt19937& random) { return Vec3f(1, 2, -1) * unit(random); }
Vec3f planar(std::mt19937& random) {
  const Vec3f point = uniform(random);
  return {point.x, point.y, 0.25f};
}
Vec3f identical(std::mt19937&) { return {0.1f, 0.2f, 0.3f}; }
/// Many points share each place, and many coordinates are alike.
Vec3f lattice(std::mt19937& random) {
  const Vec3f point = uniform(random) * 5.0f;
  return {std::floor(point.x), std::floor(point.y), std::floor(point.z)};
}

Points make_points(Maker maker, size_t count, unsigned seed = 1) {
  std::mt19937 random(seed);
  Points points;
  for (size_t i = 0; i < count; ++i) points.push_back(maker(random));
  return points;
}

std::vector<Item<Vec3f>> make_items(const Points& points) {
  std::vector<Item<Vec3f>> items;
  for (const Vec3f& point : points) items.push_back({point, int(items.size())});
  return items;
}

Tree assigned(const Points& points, const std::stop_token& stop = {}) {
  std::vector<int> data;
  for (size_t i = 0; i < points.size(); ++i) data.push_back(int(i));
  Tree tree;
  tree.assign(points, data, stop);
  return tree;
}

class KdTreeClouds : public testing::TestWithParam<Maker> {};

TEST_P(KdTreeClouds, AnswersLikeBruteForce) {
  for (size_t count : {0, 1, 2, 15, 16, 17, 127, 128, 129, 1023, 1025, 2500, 9000}) {
    SCOPED_TRACE(count);
    const Points points = make_points(GetParam(), count);
    Points queries = make_points(GetParam(), 2, 5);
    queries.push_back({0.5f, 0.5f, 0.5f});
    queries.push_back({-100.0f, 30.0f, 2.0f});
    if (count > 0) queries.push_back(points[count / 2]);
    const auto items = make_items(points);
    const Tree tree = assigned(points);
    for (uint32_t i = 0; i < count; ++i)
      ASSERT_EQ(tree.key(i), points[size_t(tree.data(i))]) << "data lost its key";
    expect_same_as_force(tree, items, queries, EuclideanMetric<3, Vec3f>());
    if (count > 1100) continue;
    Tree inserted;
    for (const auto& item : items) inserted.insert(item.key, item.data);
    expect_same_as_force(inserted, items, queries, EuclideanMetric<3, Vec3f>());
    inserted.optimise();
    expect_same_as_force(inserted, items, queries, EuclideanMetric<3, Vec3f>());
  }
}

INSTANTIATE_TEST_SUITE_P(All, KdTreeClouds,
                         testing::Values(uniform, clustered, collinear, planar, identical,
                                         lattice));

TEST(KdTree, LargeCloud) {
  const Points points = make_points(planar, large);
  const auto items = make_items(points);
  expect_same_as_force(assigned(points), items, make_points(uniform, 3, 9),
                       EuclideanMetric<3, Vec3f>());
}

// Nobody waits for order among points that nobody will look for.
TEST(KdTree, IsEmptyWhereItsBuildIsStopped) {
  std::stop_source stop;
  stop.request_stop();
  const Tree stopped = assigned(make_points(uniform, 20'000), stop.get_token());
  EXPECT_TRUE(stopped.empty());
  expect_same_as_force(stopped, {}, make_points(uniform, 3, 9), EuclideanMetric<3, Vec3f>());
}

/// For the life of this object the searches use one instruction set.
class WithInstructionSet {
 public:
  explicit WithInstructionSet(int64_t target) { use(target); }
  ~WithInstructionSet() { use(0); }

 private:
  static void use(int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

TEST(KdTree, AllInstructionSetsOfThisMachine) {
  const auto targets = hwy::SupportedAndGeneratedTargets();
  for (int64_t target : targets) {
    SCOPED_TRACE(hwy::TargetName(target));
    const WithInstructionSet chosen(target);
    for (Maker maker : {uniform, lattice, identical}) {
      const Points points = make_points(maker, 3000);
      expect_same_as_force(assigned(points), make_items(points), make_points(uniform, 3, 9),
                           EuclideanMetric<3, Vec3f>());
    }
  }
}

TEST(KdTree, ASearchCanBeUsedAgainForFewerAndMore) {
  const Points points = make_points(uniform, 3000);
  const Tree tree = assigned(points);
  const auto items = make_items(points);
  Tree::Neighbors found;
  for (size_t k : {500, 3, 50, 1, 2000}) {
    tree.nearest(points[k], k, Tree::unlimited, KdAcceptAll(), found);
    const auto expected = nearest_by_force<3>(
        items, points[k], k, infinity, EuclideanMetric<3, Vec3f>(), [](int) { return true; });
    EXPECT_EQ(found.size(), k);
    EXPECT_EQ(double(found.farthest_sq()), expected.back());
  }
}

TEST(KdTree, InsertAndRemoveStayValidAfterOptimise) {
  std::mt19937 random(4);
  std::vector<Item<Vec3f>> items;
  Tree tree;
  const Points queries = make_points(lattice, 2, 8);
  for (int round = 0; round < 6; ++round) {
    for (int i = 0; i < 400; ++i) {
      items.push_back({round % 2 ? lattice(random) : uniform(random) * 4.0f, round * 1000 + i});
      tree.insert(items.back().key, items.back().data);
    }
    for (int i = 0; i < 150; ++i) {
      const auto item = items.begin() + long(random() % items.size());
      const int data = item->data;
      EXPECT_TRUE(tree.remove(item->key, [&](uint32_t index) { return tree.data(index) == data; }));
      EXPECT_FALSE(
          tree.remove(item->key, [&](uint32_t index) { return tree.data(index) == data; }));
      items.erase(item);
    }
    expect_same_as_force(tree, items, queries, EuclideanMetric<3, Vec3f>());
    if (round % 2) tree.optimise();
    expect_same_as_force(tree, items, queries, EuclideanMetric<3, Vec3f>());
  }
  for (const auto& item : items) EXPECT_TRUE(tree.remove(item.key));
  EXPECT_TRUE(tree.empty());
  EXPECT_TRUE(tree.nearest({0, 0, 0}, 10).empty());
  tree.optimise();
  EXPECT_TRUE(tree.data().empty());
  EXPECT_TRUE(tree.nearest({0, 0, 0}, 10).empty());
}

TEST(KdTree, FindsEqualKeys) {
  Points points = make_points(uniform, 1000);
  for (int i = 0; i < 40; ++i) points.push_back(points[7]);
  Tree tree = assigned(points);
  EXPECT_EQ(tree.find(points[7]).size(), 41u);
  EXPECT_EQ(tree.find(points[8]).size(), 1u);
  EXPECT_TRUE(tree.find({9, 9, 9}).empty());
  EXPECT_FALSE(tree.remove({9, 9, 9}));
  tree.insert(points[7], -1);
  const auto matches = tree.find(points[7]);
  EXPECT_EQ(matches.size(), 42u);
  for (const auto match : matches) {
    EXPECT_EQ(match.key, points[7]);
    EXPECT_EQ(match.distance_sq, 0.0f);
    EXPECT_TRUE(match.data == -1 || points[size_t(match.data)] == points[7]);
  }
}

TEST(KdTree, PredicateOfMasksSeesOnlyNearItems) {
  const Points points = make_points(uniform, 4000);
  const Tree tree = assigned(points);
  const Vec3f query(0.5f, 0.5f, 0.5f);
  const float limit_sq = 0.04f;
  const auto odd_bits = [&](uint32_t first, uint32_t mask) {
    uint32_t result = 0;
    for (uint32_t i = 0; i < 32; ++i) {
      if ((mask >> i & 1) == 0) continue;
      EXPECT_LT(length_sq(tree.key(first + i) - query), limit_sq);
      if (tree.data(first + i) % 2 == 1) result |= 1u << i;
    }
    return result;
  };
  Tree::Neighbors found;
  tree.nearest(query, 30, limit_sq, odd_bits, found);
  const auto expected =
      nearest_by_force<3>(make_items(points), query, 30, double(limit_sq),
                          EuclideanMetric<3, Vec3f>(), [](int data) { return data % 2 == 1; });
  EXPECT_EQ(found.size(), 30u);
  EXPECT_EQ(double(found.farthest_sq()), expected.back());
}

using Key2d = std::array<double, 2>;
using Key4i = std::array<int, 4>;

template <int Dim, typename Key, typename Metric>
void test_generic(const std::vector<Key>& keys, const std::vector<Key>& queries, Metric metric) {
  std::vector<Item<Key>> items;
  std::vector<int> data;
  KdTree<Dim, Key, int, Metric> inserted(metric), given(metric);
  for (const Key& key : keys) {
    items.push_back({key, int(items.size())});
    data.push_back(items.back().data);
    inserted.insert(key, items.back().data);
  }
  given.assign(keys, data);
  expect_same_as_force(inserted, items, queries, metric);
  expect_same_as_force(given, items, queries, metric);
  for (int i = 0; i < 200; ++i) {
    const auto is_last = [&](uint32_t index) { return given.data(index) == items.back().data; };
    EXPECT_TRUE(given.remove(items.back().key, is_last));
    items.pop_back();
  }
  given.insert(keys[0], 12345);
  items.push_back({keys[0], 12345});
  expect_same_as_force(given, items, queries, metric);
  given.optimise();
  expect_same_as_force(given, items, queries, metric);
}

TEST(KdTree, TwoDimensionsInDoublePrecision) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<Key2d> keys(1500);
  for (Key2d& key : keys) key = {coordinate(random), coordinate(random)};
  test_generic<2>(keys, {keys[3], {0.1, 0.2}, {5, 5}}, EuclideanMetric<2, Key2d>());
}

TEST(KdTree, FourWholeCoordinates) {
  std::mt19937 random(3);
  std::vector<Key4i> keys(1500);
  for (Key4i& key : keys)
    for (int& value : key) value = int(random() % 12);
  test_generic<4>(keys, {keys[3], {6, 6, 6, 6}, {-9, 3, 40, 2}}, EuclideanMetric<4, Key4i>());
}

/// Squared maximum norm, stretched along z.
struct StretchedMaximum {
  using Distance = float;
  float stretch = 1.0f;
  float operator()(const Vec3f& a, const Vec3f& b) const {
    return std::max({axis(a.x - b.x, 0), axis(a.y - b.y, 1), axis(a.z - b.z, 2)});
  }
  float axis(float difference, int i) const {
    return sqr(i == 2 ? stretch * difference : difference);
  }
};

TEST(KdTree, AnotherMetric) {
  const Points points = make_points(uniform, 1500);
  test_generic<3>(points, {points[5], Vec3f(0.5f), Vec3f(2.0f)}, StretchedMaximum{4.0f});
  EXPECT_FALSE((KdTree<3, Vec3f, int, StretchedMaximum>::has_buckets));
}

TEST(KdTree, SameLayoutForAnyNumberOfThreads) {
  for (Maker maker : {uniform, lattice, collinear}) {
    const Points points = make_points(maker, large);
    Tree one, two;
    with_threads(1, [&] { one = assigned(points); });
    with_threads(2, [&] { two = assigned(points); });
    ASSERT_EQ(one.size(), two.size());
    EXPECT_TRUE(std::equal(one.data().begin(), one.data().end(), two.data().begin()));
    Tree::Neighbors a, b;
    for (const Vec3f& query : make_points(uniform, 20, 7)) {
      one.nearest(query, 50, Tree::unlimited, KdAcceptAll(), a);
      two.nearest(query, 50, Tree::unlimited, KdAcceptAll(), b);
      EXPECT_TRUE(std::ranges::equal(a.indices(), b.indices()));
    }
  }
}

TEST(KdTree, RefusesKeysThatAreNotFinite) {
  for (float bad : {std::nanf(""), infinity, -infinity, 1e18f}) {
    Tree tree = assigned({{1, 2, 3}});
    EXPECT_THROW(tree.insert({0, bad, 0}, 1), Error);
    EXPECT_THROW(tree.assign({{0, 0, 0}, {0, 0, bad}}, {1, 2}), Error);
    EXPECT_EQ(tree.size(), 1u);
    EXPECT_EQ(tree.nearest({0, 0, 0}, 5).size(), 1u);
  }
  KdTree<2, Key2d, int> plane;
  EXPECT_THROW(plane.insert({0.0, std::nan("")}, 1), Error);
}

TEST(KdTree, FarPointsAreFound) {
  Tree tree = assigned({{9e17f, 9e17f, 9e17f}, {-9e17f, -9e17f, -9e17f}});
  EXPECT_EQ(tree.nearest({-9e17f, -9e17f, -9e17f}, 5).size(), 2u);
}

TEST(KdTree, CostsLittleMemoryBesidePositionsAndData) {
  const Tree tree = assigned(make_points(uniform, large));
  EXPECT_LT(double(tree.size_in_bytes()) / double(large), 12.0 + 4.0 + 2.0);
}

}  // namespace
}  // namespace kaustik
