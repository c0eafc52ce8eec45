#include "kaustik/photon/photon_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using namespace test;

#ifdef KAUSTIK_SLOW_BUILD
constexpr size_t step = 17;
#else
constexpr size_t step = 1;
#endif

using Bytes = std::vector<uint8_t>;

/// A lamp over a floor with a mirror ball: both maps get photons.
std::shared_ptr<const Scene> lamp_over_ball(const std::string& kind = "point") {
  return make_scene(
      {light(kind), sphere(Vec3d(0, 0, 0.6), 0.4, mirror_bsdf()),
       placed("rectangle", Transform::scale(Vec3d(3, 3, 1)),
              object("bsdf", "diffuse", {{"reflectance", Rgb{0.5, 0.6, 0.7}}})),
       placed("rectangle",
              Transform::translate(Vec3d(0, 0, 3)) * Transform::rotate(Vec3d(1, 0, 0), 180),
              object("bsdf", "diffuse"))});
}

StoredPhotons traced(const Scene& scene, uint32_t photons) {
  StoredPhotons stored;
  stored.scene = "rooms/ball.xml";
  stored.fingerprint = fingerprint_of(scene);
  stored.seed = 77;
  stored.settings.global_photons = stored.settings.caustic_photons = photons;
  stored.settings.maximum_events = 9;
  stored.settings.traced = Lobes::delta;
  stored.settings.aim = Aim::projection_map;
  stored.settings.target_budget = 33;
  stored.maps = LightPass(scene, stored.settings, stored.seed).trace(stored.seed, 0);
  return stored;
}

class PhotonFile : public ::testing::Test {
 protected:
  PhotonFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "kaustik_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~PhotonFile() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name = "map.kpm") const { return folder_ / name; }

  Bytes contents() const {
    std::ifstream in(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const Bytes& bytes) const {
    std::ofstream out(path(), std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  }
  /// Expects that the file is refused with a remedy; the message holds `part`.
  void expect_refused(const std::string& part = {}) const {
    try {
      read_photon_file(path());
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_FALSE(error.problems().at(0).remedy.empty());
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(path()), std::string::npos) << error.what();
      return;
    }
    ADD_FAILURE() << "accepted; expected an error about " << part;
  }

 private:
  std::filesystem::path folder_;
};

/// The checksum of the format, written down a second time on purpose.
void seal(Bytes& bytes) {
  const size_t content = bytes.size() - 8, in_blocks = content / 32 * 32;
  uint64_t lanes[4] = {content, 1, 2, 3};
  const auto mix = [](uint64_t sum, uint64_t word) {
    const uint64_t product = (sum ^ word) * 0x9e3779b97f4a7c15ull;
    return product ^ product >> 32;
  };
  for (size_t i = 0; i < in_blocks; i += 8) {
    uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    lanes[i / 8 % 4] = mix(lanes[i / 8 % 4], word);
  }
  for (size_t i = in_blocks; i < content; ++i) lanes[0] = mix(lanes[0], bytes[i]);
  const uint64_t sum = mix(mix(mix(lanes[0], lanes[1]), lanes[2]), lanes[3]);
  std::memcpy(bytes.data() + content, &sum, 8);
}

void expect_same_map(const PhotonMap& a, const PhotonMap& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(b.size_in_bytes(), 0u) << "it stays in the file";
  EXPECT_NEAR(a.mean_flux(), b.mean_flux(), 1e-6f * a.mean_flux());
  EstimateSettings estimate;
  estimate.neighbors = 12;
  Scratch scratch;
  for (uint32_t i = 0; i < a.size(); i += 7) {
    // Every photon is there with all its data …
    const Photon& photon = a.tree().data(i);
    bool found = false;
    for (const auto& match : b.tree().find(a.tree().key(i)))
      found = found || std::memcmp(&match.data, &photon, sizeof(Photon)) == 0;
    EXPECT_TRUE(found);
    // … and what is estimated from it is the same.
    for (const float z : {1.0f, -1.0f}) {
      const auto of_a = a.irradiance(a.tree().key(i), {0, 0, z}, estimate, scratch);
      const auto of_b = b.irradiance(a.tree().key(i), {0, 0, z}, estimate, scratch);
      EXPECT_EQ(of_a.found, of_b.found);
      EXPECT_EQ(of_a.radius, of_b.radius);
      EXPECT_NEAR(of_a.value[1], of_b.value[1], 1e-5f * of_a.value[1]);
    }
  }
}

void expect_same_report(const MapReport& a, const MapReport& b) {
  EXPECT_EQ(a.rays, b.rays);
  EXPECT_EQ(a.target_count, b.target_count);
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_EQ(a.lights[i].emitted, b.lights[i].emitted);
    EXPECT_EQ(a.lights[i].stored, b.lights[i].stored);
    EXPECT_EQ(a.lights[i].nothing, b.lights[i].nothing);
    EXPECT_EQ(a.lights[i].escaped, b.lights[i].escaped);
    EXPECT_EQ(a.lights[i].absorbed, b.lights[i].absorbed);
    EXPECT_EQ(a.lights[i].too_long, b.lights[i].too_long);
    EXPECT_EQ(a.lights[i].stopped, b.lights[i].stopped);
    EXPECT_EQ(a.lights[i].stored_flux, b.lights[i].stored_flux);
  }
}

TEST_F(PhotonFile, KeepsEverything) {
  const auto scene = lamp_over_ball();
  const StoredPhotons written = traced(*scene, 20000);
  ASSERT_GT(written.maps.global.size(), 100u);
  ASSERT_GT(written.maps.caustic.size(), 100u);
  write_photon_file(path(), written);
  const StoredPhotons read = read_photon_file(path());
  EXPECT_EQ(read.scene, written.scene);
  EXPECT_TRUE(read.fingerprint.matches(written.fingerprint));
  EXPECT_EQ(read.fingerprint.sums, written.fingerprint.sums);
  EXPECT_EQ(read.seed, written.seed);
  EXPECT_TRUE(read.wavelengths.is_rgb());
  EXPECT_EQ(read.settings.global_photons, 20000u);
  EXPECT_EQ(read.settings.caustic_photons, 20000u);
  EXPECT_EQ(read.settings.maximum_events, 9);
  EXPECT_EQ(read.settings.traced, Lobes::delta);
  EXPECT_FALSE(read.settings.reradiate);
  EXPECT_EQ(read.settings.aim, Aim::projection_map);
  EXPECT_EQ(read.settings.target_budget, 33);
  expect_same_map(written.maps.global, read.maps.global);
  expect_same_map(written.maps.caustic, read.maps.caustic);
  expect_same_report(written.maps.global_report, read.maps.global_report);
  expect_same_report(written.maps.caustic_report, read.maps.caustic_report);
}

TEST_F(PhotonFile, DirectionsWithoutAnOriginAreKept) {
  const auto scene = lamp_over_ball("directional");
  const StoredPhotons written = traced(*scene, 500);
  write_photon_file(path(), written);
  const StoredPhotons read = read_photon_file(path());
  ASSERT_GT(read.maps.global.size(), 0u);
  expect_same_map(written.maps.global, read.maps.global);
}

TEST_F(PhotonFile, EqualMapsAreEqualFiles) {
  const auto scene = lamp_over_ball();
  write_photon_file(path(), traced(*scene, 300));
  const Bytes first = contents();
  write_photon_file(path(), traced(*scene, 300));
  EXPECT_EQ(contents(), first);
  StoredPhotons other = traced(*scene, 300);
  other.seed = 78;
  write_photon_file(path(), other);
  EXPECT_NE(contents(), first);
}

TEST_F(PhotonFile, EmptyMaps) {
  write_photon_file(path(), {});
  const StoredPhotons read = read_photon_file(path());
  EXPECT_TRUE(read.maps.global.empty());
  EXPECT_TRUE(read.maps.caustic.empty());
  EXPECT_TRUE(read.scene.empty());
}

TEST_F(PhotonFile, WavelengthsAreKept) {
  StoredPhotons photons;
  photons.wavelengths = {440, 500, 580, 660.5f};
  write_photon_file(path(), photons);
  EXPECT_EQ(read_photon_file(path()).wavelengths, photons.wavelengths);
  // They stand behind the frame's begin, two empty texts, the fingerprint's numbers and the seed.
  const size_t at = 16 + 8 + 8 + 8 + 8 * SceneFingerprint::sum_count + 8;
  const Bytes good = contents();
  for (const float wrong : {0.0f, -440.0f, infinity}) {
    Bytes bytes = good;
    std::memcpy(bytes.data() + at + sizeof(float), &wrong, sizeof wrong);
    seal(bytes);
    put(bytes);
    expect_refused("its wavelengths are not valid");
  }
}

TEST_F(PhotonFile, WhatIsNoPhotonMapIsRefused) {
  expect_refused("cannot read");
  put({});
  expect_refused("not a photon map");
  put({'<', 's', 'c', 'e', 'n', 'e', '/', '>', ' ', ' '});
  expect_refused("not a photon map");
}

TEST_F(PhotonFile, OtherVersionsAndByteOrdersAreNamed) {
  write_photon_file(path(), {});
  const Bytes good = contents();
  Bytes bytes = good;
  bytes[12] = 9;
  seal(bytes);
  put(bytes);
  expect_refused("has version 9, this program reads version 8");
  bytes = good;
  std::swap(bytes[8], bytes[11]);
  std::swap(bytes[9], bytes[10]);
  seal(bytes);
  put(bytes);
  expect_refused("byte order");
}

TEST_F(PhotonFile, EveryTruncationIsFound) {
  write_photon_file(path(), traced(*lamp_over_ball(), 40));
  const Bytes good = contents();
  for (size_t length = 0; length < good.size(); length += step) {
    put({good.begin(), good.begin() + std::ptrdiff_t(length)});
    expect_refused();
  }
  Bytes longer = good;
  longer.push_back(0);
  put(longer);
  expect_refused("damaged");
  put(good);
  EXPECT_NO_THROW(read_photon_file(path()));
}

TEST_F(PhotonFile, EveryFlippedBitIsFound) {
  write_photon_file(path(), traced(*lamp_over_ball(), 40));
  const Bytes good = contents();
  for (size_t i = 0; i < good.size(); i += step) {
    Bytes bytes = good;
    bytes[i] ^= uint8_t(1u << (i % 8));
    put(bytes);
    expect_refused();
  }
}

// Counts and values that lie although the checksum is right: refused, or read as what they say,
// but never a crash or an allocation beyond the file's size.
TEST_F(PhotonFile, SealedNonsenseDoesNoHarm) {
  write_photon_file(path(), traced(*lamp_over_ball(), 40));
  const Bytes good = contents();
  int refused = 0;
  for (const uint64_t value : {~uint64_t{0}, uint64_t{1} << 40, uint64_t{1} << 31, uint64_t{0}})
    for (size_t i = 0; i + 16 <= good.size(); i += 3 * step) {
      Bytes bytes = good;
      std::memcpy(bytes.data() + i, &value, 8);
      seal(bytes);
      put(bytes);
      try {
        read_photon_file(path());
      } catch (const Error& error) {
        ++refused;
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_FALSE(error.problems().at(0).remedy.empty());
      }
    }
  EXPECT_GT(refused, 0);
}

TEST_F(PhotonFile, PhotonsThatCannotBeAreRefused) {
  const StoredPhotons written = traced(*lamp_over_ball(), 40);
  ASSERT_FALSE(written.maps.caustic.empty());
  write_photon_file(path(), written);
  const Bytes good = contents();
  // The caustic map stands last: its sides end where the checksum begins.
  const size_t count = written.maps.caustic.size();
  const auto bytes_of = [&](TreePart part) { return item_count(part, count) * item_bytes(part); };
  const size_t sides = good.size() - 8 - bytes_of(TreePart::sides);
  const size_t photons = sides - (bytes_of(TreePart::photons) + 63) / 64 * 64;
  const size_t buckets = photons - bytes_of(TreePart::nodes) - bytes_of(TreePart::buckets);
  const auto with_float = [&](size_t offset, float value) {
    Bytes bytes = good;
    std::memcpy(bytes.data() + offset, &value, 4);
    seal(bytes);
    put(bytes);
  };
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, 1e19f}) {
    with_float(buckets + 16 * sizeof(float), value);
    expect_refused("photon 0 is not valid");
  }
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), infinity, -1.0f}) {
    with_float(photons + 8, value);
    expect_refused("photon 0 is not valid");
  }
  with_float(photons + 16, -1.0f);
  expect_refused("photon 0 is not valid");
  with_float(photons + 16, infinity);
  EXPECT_NO_THROW(read_photon_file(path()));
  // A search would find it.
  ASSERT_NE(count % KdBuckets::bucket_size, 0u);
  with_float(photons - bytes_of(TreePart::nodes) - 4 - 2 * 16 * sizeof(float), 1);
  expect_refused("behind its last photon");
}

TEST_F(PhotonFile, MapsOutliveTheirFile) {
  const auto scene = lamp_over_ball();
  const StoredPhotons written = traced(*scene, 2000);
  write_photon_file(path(), written);
  const StoredPhotons read = read_photon_file(path());
  write_photon_file(path(), traced(*scene, 40));
  std::filesystem::remove(path());
  expect_same_map(written.maps.global, read.maps.global);
}

TEST_F(PhotonFile, WhatStandsThereSurvivesAFailedWrite) {
  const StoredPhotons written = traced(*lamp_over_ball(), 40);
  write_photon_file(path(), written);
  const Bytes good = contents();
  EXPECT_THROW(write_photon_file(path("map.kpm/below.kpm"), written), Error);
  EXPECT_THROW(write_photon_file(path("missing/map.kpm"), written), Error);
  EXPECT_EQ(contents(), good);
}

}  // namespace
}  // namespace kaustik
