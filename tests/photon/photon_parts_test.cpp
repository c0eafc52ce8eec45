// Photons that are traced in parts are those of the whole pass.
#include "kaustik/photon/photon_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/photon/emission_scenes.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

std::shared_ptr<const Scene> lamps_and_mirror() {
  return make_scene(
      {light("point"), sphere(Vec3d(0, 0, 0.6), 0.4, mirror_bsdf()),
       placed("rectangle", Transform::scale(Vec3d(3, 3, 1)),
              object("bsdf", "diffuse", {{"reflectance", Rgb{0.5, 0.6, 0.7}}})),
       placed("rectangle",
              Transform::translate(Vec3d(0, 0, 3)) * Transform::rotate(Vec3d(1, 0, 0), 180),
              object("bsdf", "diffuse"))});
}

StoredPhotons traced_part(const Scene& scene, PhotonPart part, uint64_t seed = 5) {
  StoredPhotons stored;
  stored.fingerprint = fingerprint_of(scene);
  stored.seed = seed;
  stored.settings.global_photons = 30'000;
  stored.settings.caustic_photons = 20'000;
  stored.settings.part = part;
  stored.maps = LightPass(scene, stored.settings, seed).trace(seed, 0);
  sort_photons(stored.maps);
  return stored;
}

std::vector<StoredPhotons> parts_of(const Scene& scene, uint32_t count) {
  std::vector<StoredPhotons> parts;
  for (uint32_t i = 0; i < count; ++i) parts.push_back(traced_part(scene, {i, count}));
  return parts;
}

void expect_same(const PhotonMap& a, const PhotonMap& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 1000u);
  for (uint32_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a.tree().key(i), b.tree().key(i)) << i;
    ASSERT_EQ(std::memcmp(&a.tree().data(i), &b.tree().data(i), sizeof(Photon)), 0) << i;
  }
}

TEST(PhotonParts, MergedAreTheWholePass) {
  const auto scene = lamps_and_mirror();
  const StoredPhotons whole = traced_part(*scene, PhotonPart{});
  for (const uint32_t count : {1u, 2u, 5u, 40u}) {
    SCOPED_TRACE(count);
    std::vector<StoredPhotons> parts = parts_of(*scene, count);
    std::reverse(parts.begin(), parts.end());
    const StoredPhotons merged = merged_photons(parts);
    EXPECT_TRUE(merged.settings.part.is_whole());
    expect_same(merged.maps.global, whole.maps.global);
    expect_same(merged.maps.caustic, whole.maps.caustic);
    const LightCounts a = merged.maps.global_report.total(), b = whole.maps.global_report.total();
    EXPECT_EQ(a.emitted, b.emitted);
    EXPECT_EQ(a.stored, b.stored);
    EXPECT_EQ(a.absorbed, b.absorbed);
    EXPECT_NEAR(a.stored_flux, b.stored_flux, 1e-9 * b.stored_flux);
  }
}

std::string bytes_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(PhotonParts, MergedOnTheDiskHaveTheBytesOfTheWholePass) {
  const auto scene = lamps_and_mirror();
  const TemporaryFolder folder;
  const StoredPhotons whole = traced_part(*scene, PhotonPart{});
  write_photon_file(folder.path("whole.kpm"), whole);
  const std::vector<StoredPhotons> parts = parts_of(*scene, 5);
  // Runs of a few photons, and all at once.
  for (const size_t in_memory : {size_t{700}, size_t{1} << 20}) {
    SCOPED_TRACE(in_memory);
    std::vector<double> told;
    const PhotonCounts counts = write_merged_photons(
        folder.path("merged.kpm"), parts, [&](double share) { told.push_back(share); }, in_memory);
    EXPECT_EQ(counts[0], whole.maps.global.size());
    EXPECT_EQ(counts[1], whole.maps.caustic.size());
    EXPECT_EQ(read_photon_file(folder.path("merged.kpm")).maps.global_report.total().stored,
              counts[0]);
    // The sums of flux differ in their last bits: they are added in another order.
    StoredPhotons merged = read_photon_file(folder.path("merged.kpm"));
    merged.maps.global_report = whole.maps.global_report;
    merged.maps.caustic_report = whole.maps.caustic_report;
    write_photon_file(folder.path("merged.kpm"), merged);
    EXPECT_EQ(bytes_of_file(folder.path("merged.kpm")), bytes_of_file(folder.path("whole.kpm")));
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_LE(told.empty() ? 1 : told.back(), 1);
  }
  // Nothing of what was kept meanwhile is left.
  const std::filesystem::directory_iterator entries(folder.path(""));
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 2);
}

TEST(PhotonParts, WrongPartsLeaveNoFile) {
  const auto scene = lamps_and_mirror();
  const TemporaryFolder folder;
  const std::vector<StoredPhotons> parts = parts_of(*scene, 2);
  EXPECT_THROW(write_merged_photons(folder.path("merged.kpm"), std::span(parts).first(1)), Error);
  EXPECT_THROW(write_merged_photons(folder.path("missing/merged.kpm"), parts), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path("")));
}

TEST(PhotonParts, PartsDiffer) {
  const auto scene = lamps_and_mirror();
  const std::vector<StoredPhotons> parts = parts_of(*scene, 3);
  EXPECT_NE(parts[0].maps.global.tree().key(0), parts[1].maps.global.tree().key(0));
  for (const StoredPhotons& part : parts)
    EXPECT_NEAR(double(part.maps.global_report.total().emitted), 10'000, 2048);
}

std::string problem_with(std::vector<StoredPhotons> parts) {
  try {
    merged_photons(parts);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(PhotonParts, WhatDoesNotFitIsRefused) {
  const auto scene = lamps_and_mirror();
  const std::vector<StoredPhotons> parts = parts_of(*scene, 2);
  EXPECT_NE(problem_with({}).find("no photon map"), std::string::npos);
  EXPECT_NE(problem_with({parts[0]}).find("part 2 of 2 is missing"), std::string::npos);
  EXPECT_NE(problem_with({parts[1], parts[1]}).find("part 2 of 2 comes twice"), std::string::npos);
  EXPECT_NE(problem_with({parts[0], traced_part(*scene, {1, 2}, 6)}).find("different seeds"),
            std::string::npos);
  EXPECT_NE(
      problem_with({parts[0], traced_part(*scene, {1, 3})}).find("different seeds or settings"),
      std::string::npos);
  StoredPhotons other = parts[1];
  other.fingerprint.sums[3] += 1;
  EXPECT_NE(problem_with({parts[0], other}).find("different scenes"), std::string::npos);
  other = parts[1];
  other.wavelengths = {440, 500, 580, 660};
  EXPECT_NE(problem_with({parts[0], other}).find("different wavelengths"), std::string::npos);
  EXPECT_EQ(problem_with(parts), "none");
}

}  // namespace
}  // namespace kaustik
