#include "kaustik/base/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "kaustik/base/statistics.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int count = 20000;
constexpr double planted_error = 0.065;
#else
constexpr int count = 200000;
constexpr double planted_error = 0.02;
#endif

/// The point of pair number `pair`.
Vec2f point(Sampler sampler, uint32_t pair) {
  for (uint32_t i = 0; i < pair; ++i) sampler.next_2d();
  return sampler.next_2d();
}

/// Whether 2^k points lie one in each of the 2^k boxes of every shape 2^−a × 2^(a−k).
bool is_net(const std::vector<Vec2f>& points) {
  const int k = int(std::lround(std::log2(double(points.size()))));
  for (int a = 0; a <= k; ++a) {
    std::set<std::pair<int, int>> boxes;
    for (const Vec2f& p : points)
      boxes.insert({int(std::ldexp(p.x, a)), int(std::ldexp(p.y, k - a))});
    if (boxes.size() != points.size()) return false;
  }
  return true;
}

std::vector<Vec2f> points_of(uint64_t scramble, uint32_t first, uint32_t number, uint32_t pair) {
  std::vector<Vec2f> points;
  for (uint32_t i = 0; i < number; ++i) points.push_back(point(Sampler(scramble, first + i), pair));
  return points;
}

TEST(sampler, every_aligned_run_of_powers_of_two_is_a_net) {
  for (const uint64_t scramble : {1ull, 0xdeadbeefull, ~0ull})
    for (const uint32_t pair : {0u, 1u, 9u, 31u})
      for (uint32_t k = 0; k <= 10; ++k)
        for (const uint32_t run : {0u, 1u, 5u})
          EXPECT_TRUE(is_net(points_of(scramble, run << k, 1u << k, pair)))
              << scramble << " " << pair << " " << k << " " << run;
}

TEST(sampler, net_check_finds_one_wrong_point) {
  std::vector<Vec2f> points = points_of(1, 0, 256, 0);
  points[77].x = std::fmod(points[77].x + 0.02f, 1.0f);
  EXPECT_FALSE(is_net(points));
}

TEST(sampler, deep_dimensions_are_not_stratified_but_uniform) {
  EXPECT_FALSE(is_net(points_of(1, 0, 256, Sampler::stratified_pairs)));
}

TEST(sampler, numbers_lie_in_the_half_open_unit_square) {
  for (uint32_t i = 0; i < 5000; ++i)
    for (const uint32_t pair : {0u, 3u, 40u}) {
      const Vec2f p = point(Sampler(5, i), pair);
      ASSERT_GE(p.x, 0);
      ASSERT_LT(p.x, 1);
      ASSERT_GE(p.y, 0);
      ASSERT_LT(p.y, 1);
    }
}

/// P values of the 8 × 8 cells being hit alike, and of a 2 % difference between halves of them.
void expect_uniform(const std::vector<Vec2f>& points) {
  std::vector<double> hits(64), expected(64, double(points.size()) / 64);
  for (const Vec2f& p : points) hits[size_t(int(p.x * 8) * 8 + int(p.y * 8))] += 1;
  EXPECT_GT(chi_square_p_value(hits, expected), 1e-4);
  for (size_t i = 0; i < 64; ++i) expected[i] *= i % 2 ? 1 + planted_error : 1 - planted_error;
  EXPECT_LT(chi_square_p_value(hits, expected), 1e-4);
}

TEST(sampler, is_uniform_over_scrambles) {
  for (const uint32_t pair : {0u, 5u, 33u}) {
    std::vector<Vec2f> points;
    for (int i = 0; i < 2 * count; ++i)
      points.push_back(point(Sampler(hash_mix(3, uint64_t(i)), 6), pair));
    expect_uniform(points);
  }
}

TEST(sampler, two_pairs_are_independent) {
  // x of one dimension pair against x of another, at the same index, over scrambles.
  for (const auto& [a, b] : {std::pair{0u, 1u}, {2u, 7u}, {31u, 32u}}) {
    std::vector<Vec2f> points;
    for (int i = 0; i < 2 * count; ++i) {
      const Sampler s(hash_mix(4, uint64_t(i)), 1);
      points.push_back({point(s, a).x, point(s, b).x});
    }
    expect_uniform(points);
  }
}

TEST(sampler, two_scrambles_are_independent) {
  // Neighbouring seeds, passes, streams, elements: the same index of both, against one another.
  const auto pair_up = [](auto first, auto second) {
    std::vector<Vec2f> points;
    for (uint32_t i = 0; i < 2 * count; ++i) {
      Sampler a = first(i), b = second(i);
      points.push_back({a.next_2d().x, b.next_2d().x});
    }
    return points;
  };
  const auto at = [](uint64_t seed, uint32_t pass, Stream stream, uint64_t element) {
    return [=](uint32_t i) { return Sampler::at(seed, pass, stream, element + 2 * i, 3); };
  };
  const auto base = at(1, 0, Stream::camera, 0);
  expect_uniform(pair_up(base, at(2, 0, Stream::camera, 0)));
  expect_uniform(pair_up(base, at(1, 1, Stream::camera, 0)));
  expect_uniform(pair_up(base, at(1, 0, Stream::photon_global, 0)));
  expect_uniform(pair_up(base, at(1, 0, Stream::camera, 1)));
}

TEST(sampler, same_address_gives_the_same_numbers) {
  Sampler a = Sampler::at(1, 2, Stream::cache, 3, 4), b = Sampler::at(1, 2, Stream::cache, 3, 4);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(a.next_2d(), b.next_2d());
  Sampler c = Sampler::at(1, 2, Stream::cache, 3, 4), d = Sampler::at(1, 2, Stream::cache, 3, 4);
  EXPECT_EQ(c.next_1d(), d.next_2d().x);
}

TEST(sampler, vertices_have_fixed_blocks) {
  Sampler a(7, 9), b(7, 9);
  for (int i = 0; i < 5; ++i) a.next_1d();
  a.start_vertex(2);
  b.start_vertex(2);
  EXPECT_EQ(a.next_2d(), b.next_2d());
  a.start_vertex(0);
  EXPECT_EQ(a.next_2d(), point(Sampler(7, 9), Sampler::pairs_per_vertex));
}

TEST(sampler, branches_stratify_one_another) {
  Sampler parent(7, 9);
  parent.next_2d();
  std::vector<Vec2f> branches;
  for (uint32_t i = 0; i < 64; ++i)
    branches.push_back(parent.split(Split::gather_ray, i).next_2d());
  EXPECT_TRUE(is_net(branches));
  // Over another key, or from the next point of the parent, they differ.
  EXPECT_NE(parent.split(Split::specular_ray, 0).next_2d(), branches[0]);
  parent.next_2d();
  EXPECT_NE(parent.split(Split::gather_ray, 0).next_2d(), branches[0]);
}

TEST(sampler, forks_are_stratified_over_the_indices_of_the_parent) {
  std::vector<Vec2f> first, second;
  for (uint32_t i = 0; i < 256; ++i) {
    Sampler parent(5, i);
    parent.next_2d();
    first.push_back(parent.fork(Fork::light, 0).next_2d());
    second.push_back(parent.fork(Fork::light, 1).next_2d());
  }
  EXPECT_TRUE(is_net(first));
  EXPECT_TRUE(is_net(second));
  EXPECT_NE(first, second);
}

TEST(sampler, several_samples_of_each_index_are_stratified_together) {
  std::vector<Vec2f> points, of_three;
  for (uint32_t i = 0; i < 64; ++i) {
    Sampler parent(5, i);
    parent.next_2d();
    for (uint32_t k = 0; k < 4; ++k)
      points.push_back(parent.one_of(Series::light_sample, 4, k).next_2d());
    for (uint32_t k = 0; k < 3; ++k)
      of_three.push_back(parent.one_of(Series::light_sample, 3, k).next_2d());
    parent.next_2d();
    EXPECT_NE(parent.one_of(Series::light_sample, 4, 0).next_2d(), points[4 * size_t(i)]);
  }
  EXPECT_TRUE(is_net(points));
  of_three.resize(128);
  EXPECT_TRUE(is_net(of_three));
  EXPECT_NE(points[0], of_three[0]);
}

TEST(sampler, branches_of_different_parents_are_independent) {
  std::vector<Vec2f> points;
  for (uint32_t i = 0; i < uint32_t(count); ++i)
    points.push_back({Sampler(1, 2 * i).split(Split::gather_ray, 0).next_1d(),
                      Sampler(1, 2 * i + 1).split(Split::gather_ray, 0).next_1d()});
  for (uint32_t i = 0; i < uint32_t(count); ++i)
    points.push_back({Sampler(2, i).split(Split::gather_ray, 0).next_1d(),
                      Sampler(2, i).split(Split::specular_ray, 0).next_1d()});
  expect_uniform(points);
}

TEST(sampler, stratification_pays) {
  // The mean of x·y over 256 points has a far smaller variance than that of random ones.
  RunningStatistics net, random;
  for (uint64_t scramble = 0; scramble < 200; ++scramble) {
    double net_sum = 0, random_sum = 0;
    for (uint32_t i = 0; i < 256; ++i) {
      const Vec2f p = Sampler(hash_mix(11, scramble), i).next_2d();
      const Vec2f q = Sampler(hash_mix(scramble, i), 0).next_2d();
      net_sum += p.x * p.y;
      random_sum += q.x * q.y;
    }
    net.add(net_sum / 256);
    random.add(random_sum / 256);
  }
  EXPECT_LT(net.variance() * 200, random.variance());
  EXPECT_GT(z_test_p_value(net, 0.25), 1e-4);
  EXPECT_GT(z_test_p_value(random, 0.25), 1e-4);
}

/// They are the numbers that deep pairs have anyway; a pair each.
TEST(sampler, independent_numbers_are_those_of_deep_pairs) {
  Sampler deep(5, 3), independent(5, 3);
  for (uint32_t i = 0; i < Sampler::stratified_pairs; ++i) {
    const Vec2f u = deep.next_2d(), v = independent.next_independent_2d();
    EXPECT_NE(u, v) << i;
  }
  for (int i = 0; i < 10; ++i) EXPECT_EQ(deep.next_2d(), independent.next_independent_2d());
}

}  // namespace
}  // namespace kaustik
