// Trees of photons that are built piece by piece.
#include "kaustik/photon/photon_tree_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>

#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

/// Photons on some planes and in a dense spot, as light leaves them.
std::vector<PhotonRecord> random_photons(size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> even(-1, 1);
  std::vector<PhotonRecord> records;
  for (size_t i = 0; i < count; ++i) {
    Vec3f position{even(random), even(random), 0.2f * even(random)};
    if (i % 3 == 0) position.z = 0.5f;
    if (i % 5 == 0) position = {0.3f + 0.01f * position.x, 0.01f * position.y, 0.5f};
    Photon photon;
    photon.path = uint32_t(i);
    photon.side = CoarseNormal({0, 0, i % 2 == 0 ? 1.0f : -1.0f});
    photon.flux.lanes[1] = 1 + even(random);
    records.emplace_back(position, photon);
  }
  return records;
}

PhotonBounds unit_bounds() { return {{-1, -1, -1}, {1, 1, 1}}; }

PhotonMap built(const std::vector<PhotonRecord>& records, const SortMemory& memory = {}) {
  PhotonSort sort(unit_bounds(), memory);
  for (const PhotonRecord& record : records) sort.add(record);
  return BuiltPhotonTree(sort, records.size()).map();
}

TEST(PhotonOrder, NeighboursOnTheCurveAreNeighboursInSpace) {
  // Cubes of an eighth of the side, each by a point within.
  const PhotonOrder order({{0, 0, 0}, {8, 8, 8}});
  std::map<uint64_t, Vec3f> along;
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z) {
        const Vec3f center{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f};
        along[order.place_on_curve(center)] = center;
      }
  ASSERT_EQ(along.size(), 512u);
  const Vec3f* last = nullptr;
  for (const auto& [place, center] : along) {
    if (last) {
      EXPECT_EQ(length(center - *last), 1) << place;
    }
    last = &center;
  }
}

TEST(PhotonOrder, WhatLiesOutsideOrInOnePlaceHasAPlace) {
  const PhotonOrder flat({{1, 1, 1}, {1, 1, 1}}), unit({{0, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(flat.place_on_curve({1, 1, 1}), flat.place_on_curve({2, 5, -7}));
  EXPECT_EQ(unit.place_on_curve({1, 1, 1}), unit.place_on_curve({9, 9, 9}));
  EXPECT_EQ(PhotonOrder({}).place_on_curve({3, 4, 5}), 0u);
}

void expect_same_bytes(const PhotonMap& a, const PhotonMap& b) {
  EXPECT_EQ(a.mean_flux(), b.mean_flux());
  const auto same = [](const auto& x, const auto& y) {
    return x.size_bytes() == y.size_bytes() && std::memcmp(x.data(), y.data(), x.size_bytes()) == 0;
  };
  EXPECT_TRUE(same(a.tree().buckets().buckets(), b.tree().buckets().buckets()));
  EXPECT_TRUE(same(a.tree().buckets().nodes(), b.tree().buckets().nodes()));
  EXPECT_TRUE(same(a.tree().data(), b.tree().data()));
  EXPECT_TRUE(same(a.sides().blocks(), b.sides().blocks()));
}

TEST(PhotonTreeBuilder, TheOrderOfPhotonsAndTheMemoryMakeNoDifference) {
  std::vector<PhotonRecord> records = random_photons(20'000);
  const PhotonMap map = built(records);
  std::shuffle(records.begin(), records.end(), std::mt19937(3));
  const test::TemporaryFolder folder;
  for (const size_t in_memory : {size_t{1}, size_t{333}, size_t{19'999}, size_t{20'000}}) {
    if (in_memory == 1) {
      const std::vector<PhotonRecord> few(records.begin(), records.begin() + 50);
      expect_same_bytes(built(few, {in_memory, folder.path("map")}), built(few));
    } else {
      expect_same_bytes(built(records, {in_memory, folder.path("map")}), map);
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path("")));
}

/// The nearest neighbours of some places are those that a search of all photons finds.
void expect_neighbours(const PhotonMap& map, const std::vector<PhotonRecord>& records) {
  ASSERT_EQ(map.size(), records.size());
  std::mt19937 random(11);
  constexpr size_t count = 20;
  for (int i = 0; i < 12; ++i) {
    const Vec3f query = records[random() % records.size()].position();
    std::vector<std::pair<float, uint32_t>> expected;
    for (const PhotonRecord& record : records)
      expected.emplace_back(length_sq(record.position() - query), record.photon.path);
    std::nth_element(expected.begin(), expected.begin() + count, expected.end());
    std::sort(expected.begin(), expected.begin() + count);
    const auto found = map.tree().nearest(query, count);
    ASSERT_EQ(found.size(), count);
    for (size_t j = 0; j < count; ++j) {
      EXPECT_FLOAT_EQ(found[j].distance_sq, expected[j].first);
      // What belongs to a photon has come along.
      const PhotonRecord& record = records[found[j].data.path];
      EXPECT_EQ(record.position(), found[j].key);
    }
  }
}

TEST(PhotonTreeBuilder, SearchesFindWhatASearchOfAllFinds) {
  const std::vector<PhotonRecord> records = random_photons(3000);
  expect_neighbours(built(records), records);
}

TEST(PhotonTreeBuilder, OnePieceIsTheTreeOfAllAtOnce) {
  const std::vector<PhotonRecord> records = random_photons(5000);
  const PhotonMap map = built(records);
  std::vector<Vec3f> positions;
  std::vector<Photon> photons;
  PhotonSort sort(unit_bounds(), {});
  for (const PhotonRecord& record : records) sort.add(record);
  sort.drain(records.size(), [&](std::span<const PhotonRecord> sorted) {
    for (const PhotonRecord& record : sorted) {
      positions.push_back(record.position());
      photons.push_back(record.photon);
    }
  });
  expect_same_bytes(map, PhotonMap(std::move(positions), std::move(photons)));
}

#ifndef KAUSTIK_SLOW_BUILD
constexpr size_t piece = size_t{16} << 15;

TEST(PhotonTreeBuilder, PiecesMakeOneTree) {
  // One piece; two and some photons.
  for (const size_t count : {piece, 2 * piece + 5}) {
    SCOPED_TRACE(count);
    const std::vector<PhotonRecord> records = random_photons(count);
    expect_neighbours(built(records), records);
  }
}

TEST(PhotonTreeBuilder, NinePiecesMakeOneTreeLong) {
  // There is a level above that of pieces.
  const std::vector<PhotonRecord> records = random_photons(8 * piece + 200);
  expect_neighbours(built(records), records);
}
#endif

}  // namespace
}  // namespace kaustik
