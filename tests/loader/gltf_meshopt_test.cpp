// What meshoptimizer 0.18 has packed, unpacked again.

#include "kaustik/loader/gltf/gltf_meshopt.h"

#include <random>
#include <set>

#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

using gltf::MeshoptFilter;
using gltf::MeshoptLayout;
using gltf::MeshoptMode;

std::string bytes_of(std::string_view digits) {
  std::string bytes;
  for (size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += char(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
  return bytes;
}

template <typename T>
std::vector<T> unpacked_as(const std::string& packed, const MeshoptLayout& layout) {
  const auto bytes = gltf::unpacked_by_meshopt(std::as_bytes(std::span(packed)), layout);
  if (!bytes) return {};
  EXPECT_EQ(bytes->size(), layout.count * layout.stride);
  std::vector<T> numbers(bytes->size() / sizeof(T));
  std::memcpy(numbers.data(), bytes->data(), bytes->size());
  return numbers;
}

/// Twenty vertices (i, i²/2, −1).
const std::string curve = bytes_of(
    "a000000700ffff80804040404020202020202020ff0000002010101001380080007e00043f000000"
    "ffffff07000000dfe090906878444c543c32363aff0000003e20242405388080007e800000000000"
    "000000000000000000000000000000000000000000000000000000000000000080bf");
/// A square of four by four, whose vertices stand in rows of five.
const std::string grid = bytes_of(
    "e1fe1e100e100e100ece1e160e150e140ece1e140e140e140ece1e140e140e140e0f0a0076875667"
    "78a9866589689801690000");
const std::string sequence = bytes_of("d10004040c0681b5181000000000");

MeshoptLayout attributes(size_t count, size_t stride, MeshoptFilter filter = MeshoptFilter::none) {
  return {MeshoptMode::attributes, filter, count, stride};
}

TEST(GltfMeshopt, AttributesAreDifferencesOfBytes) {
  const std::vector<float> numbers = unpacked_as<float>(curve, attributes(20, 12));
  ASSERT_EQ(numbers.size(), 60u);
  for (size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(numbers[3 * i], float(i));
    EXPECT_EQ(numbers[3 * i + 1], 0.5f * float(i * i));
    EXPECT_EQ(numbers[3 * i + 2], -1);
  }
}

TEST(GltfMeshopt, TheExampleOfTheSpecification) {
  // Sixteen differences in four bits each, of the first byte; the other three bytes stay.
  const std::string packed = bytes_of(
                                 "a0"
                                 "02"
                                 "175ff0bc77a9210034b5"
                                 "00"
                                 "00"
                                 "00") +
                             std::string(32, '\0');
  const std::vector<uint8_t> bytes = unpacked_as<uint8_t>(packed, attributes(16, 4));
  ASSERT_EQ(bytes.size(), 64u);
  const int differences[] = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
  uint8_t value = 0;
  for (size_t i = 0; i < 16; ++i) {
    value = uint8_t(value + differences[i]);
    EXPECT_EQ(bytes[4 * i], value) << i;
    EXPECT_EQ(bytes[4 * i + 1], 0);
  }
}

TEST(GltfMeshopt, TrianglesAndIndices) {
  const std::vector<uint32_t> faces =
      unpacked_as<uint32_t>(grid, {MeshoptMode::triangles, MeshoptFilter::none, 96, 4});
  ASSERT_EQ(faces.size(), 96u);
  // Each square has two triangles, whose corners may be turned round.
  for (uint32_t square = 0; square < 16; ++square) {
    const uint32_t a = square / 4 * 5 + square % 4;
    const uint32_t* six = &faces[6 * square];
    EXPECT_EQ((std::set<uint32_t>{six[0], six[1], six[2]}), (std::set<uint32_t>{a, a + 1, a + 5}));
    EXPECT_EQ((std::set<uint32_t>{six[3], six[4], six[5]}),
              (std::set<uint32_t>{a + 5, a + 1, a + 6}));
  }
  const MeshoptLayout words = {MeshoptMode::indices, MeshoptFilter::none, 7, 4};
  EXPECT_EQ(unpacked_as<uint32_t>(sequence, words),
            (std::vector<uint32_t>{0, 1, 2, 5, 3, 100000, 7}));
}

TEST(GltfMeshopt, FiltersRestoreVectors) {
  // (0.6, 0, 0.8), (0, −0.6, −0.8) and (1, 0, 0): times 127, and times 32767.
  EXPECT_EQ(
      unpacked_as<int8_t>(
          bytes_of(
              "a0013c000000266c013c000000fdfe00000000000000000000000000000000000000000000000000"
              "000000000036007f00"),
          attributes(3, 4, MeshoptFilter::octahedral)),
      (std::vector<int8_t>{76, 0, 102, 0, 0, -76, -102, 0, 127, 0, 0, 0}));
  EXPECT_EQ(
      unpacked_as<int16_t>(
          bytes_of(
              "a0013c0000004ada012c000000060124000000013c0000000f100000000000000000000000000000"
              "00000000000000000000000000006d030000ff070000"),
          attributes(3, 8, MeshoptFilter::octahedral)),
      (std::vector<int16_t>{19653, 0, 26219, 0, 0, -19653, -26219, 0, 32767, 0, 0, 0}));
  // (0, 0, 0, 1), (0.5, −0.5, 0.5, 0.5) and (0.8, 0, 0.6, 0).
  const std::vector<int16_t> turns = unpacked_as<int16_t>(
      bytes_of("a0013c000000fcfb013c000000b5b6013c000000fb34013c000000b424013c000000fbfc013c0000"
               "00b4b301300000000500000000000000000000000000000000000000000000000000000000000000"
               "ff7f"),
      attributes(3, 8, MeshoptFilter::quaternion));
  const std::vector<int> wanted = {0, 0, 0, 32767, 16384, -16384, 16384, 16384, 26214, 0, 19660, 0};
  ASSERT_EQ(turns.size(), wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(turns[i], wanted[i], 1);
  const std::vector<float> numbers = unpacked_as<float>(
      bytes_of("a0013000000027000001300000000f0130000000080120000000012000000001300000000f013000"
               "0000ff01300000001b0001300000000f0000000000000000000000000000000000000000180000fc"
               "fcfffffc803e00fc"),
      attributes(2, 12, MeshoptFilter::exponential));
  EXPECT_EQ(numbers, (std::vector<float>{1.5f, -0.25f, 1000, 1 / 1024.0f, 0, 3}));
}

TEST(GltfMeshopt, WhatIsDamagedIsRefused) {
  EXPECT_TRUE(unpacked_as<float>(curve, attributes(20, 13)).empty());
  EXPECT_TRUE(unpacked_as<float>(curve, attributes(500, 12)).empty());
  EXPECT_TRUE(unpacked_as<float>(grid, attributes(20, 12)).empty());
  const MeshoptLayout faces = {MeshoptMode::triangles, MeshoptFilter::none, 96, 4};
  for (size_t size = 0; size < grid.size(); ++size)
    EXPECT_TRUE(unpacked_as<uint32_t>(grid.substr(0, size), faces).empty()) << size;
  std::mt19937 random(4);
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = round % 2 ? curve : grid;
    for (unsigned flips = 1 + random() % 3; flips > 0; --flips)
      bytes[random() % bytes.size()] = char(random());
    if (round % 2)
      unpacked_as<float>(bytes, attributes(20, 12));
    else
      unpacked_as<uint32_t>(bytes, faces);
  }
}

TEST(GltfMeshopt, ViewsOfAFileAreUnpacked) {
  GltfBuffer buffer;
  const int positions = buffer.add_view(curve), faces = buffer.add_view(grid);
  const auto file = [&](const std::string& mode) {
    return "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"EXT_meshopt_compression\"],"
           "\"buffers\":[{\"uri\":\"data:;base64," +
           to_base64(buffer.bytes()) +
           "\",\"byteLength\":" + std::to_string(buffer.bytes().size()) +
           R"(},{"byteLength":1000}],"bufferViews":[
      {"buffer":1,"byteLength":240,"byteStride":12,"extensions":{"EXT_meshopt_compression":
       {"buffer":0,"byteOffset":0,"byteLength":)" +
           std::to_string(curve.size()) + R"(,"byteStride":12,"count":20,"mode":")" + mode +
           R"("}}},{"buffer":1,"byteOffset":240,"byteLength":192,"extensions":{
       "EXT_meshopt_compression":{"buffer":0,"byteOffset":)" +
           std::to_string(buffer.bytes().size() - grid.size()) + R"(,"byteLength":)" +
           std::to_string(grid.size()) +
           R"(,"byteStride":2,"count":96,"mode":"TRIANGLES"}}}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":20,"type":"VEC3","min":[0,0,-1],
       "max":[19,180.5,-1]},{"bufferView":1,"componentType":5123,"count":48,"type":"SCALAR"}],
      "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]})";
  };
  ASSERT_EQ(positions, 0);
  ASSERT_EQ(faces, 1);
  const Description description = parse_gltf_text(file("ATTRIBUTES"));
  const Object& shape = only_in(*description.scene, "shape");
  ASSERT_EQ(shape.type, "mesh");
  EXPECT_EQ(floats_of(shape, "positions")[57], 19);
  EXPECT_EQ(floats_of(shape, "faces").size(), 48u);
  // In another way it is a box.
  const Description other = parse_gltf_text(file("SPLATS"));
  EXPECT_EQ(only_in(*other.scene, "shape").type, "cube");
  EXPECT_TRUE(has_deviation(other, DeviationKind::missing, "EXT_meshopt_compression"));
}

}  // namespace
}  // namespace kaustik::test
