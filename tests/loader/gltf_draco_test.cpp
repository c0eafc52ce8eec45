// Meshes of glTF that KHR_draco_mesh_compression has packed.

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

/// A corner of the mesh that is packed: a bowl over a grid, with a seam in its colours.
struct Corner {
  std::array<float, 3> position;
  std::array<uint8_t, 4> color;
};

constexpr int side = 6;
constexpr int face_count = 2 * side * side;

Corner corner_of(int x, int y, bool is_left) {
  const float u = float(x) / side, v = float(y) / side;
  return {{u, v, u * u + v * v}, {uint8_t(is_left ? 255 : 51), 102, uint8_t(40 * y), 255}};
}

/// The three corners of each face.
std::vector<std::array<Corner, 3>> bowl() {
  std::vector<std::array<Corner, 3>> faces;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const bool is_left = x < side / 2;
      const auto at = [&](int i, int k) { return corner_of(x + i, y + k, is_left); };
      faces.push_back({at(0, 0), at(1, 0), at(0, 1)});
      faces.push_back({at(1, 0), at(1, 1), at(0, 1)});
    }
  return faces;
}

struct Packed {
  std::string bytes;
  uint32_t position_id = 0, color_id = 0;
  size_t points = 0;
};

/// With a further attribute of so many numbers, if there are any.
Packed packed_bowl(int method, int8_t further_components = 0) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(face_count);
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8, true);
  const std::vector<float> further_values(size_t(further_components), 1.f);
  const int further = further_components == 0
                          ? -1
                          : builder.AddAttribute(draco::GeometryAttribute::GENERIC,
                                                 further_components, draco::DT_FLOAT32);
  const auto faces = bowl();
  for (int i = 0; i < face_count; ++i) {
    const auto& face = faces[size_t(i)];
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(uint32_t(i)),
                                      face[0].position.data(), face[1].position.data(),
                                      face[2].position.data());
    builder.SetAttributeValuesForFace(color, draco::FaceIndex(uint32_t(i)), face[0].color.data(),
                                      face[1].color.data(), face[2].color.data());
    if (further >= 0)
      builder.SetAttributeValuesForFace(further, draco::FaceIndex(uint32_t(i)),
                                        further_values.data(), further_values.data(),
                                        further_values.data());
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 16);
  encoder.SetTrackEncodedProperties(true);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) throw std::runtime_error("not encoded");
  return {std::string(buffer.data(), buffer.size()), mesh->attribute(position)->unique_id(),
          mesh->attribute(color)->unique_id(), encoder.num_encoded_points()};
}

std::string file_of(const Packed& packed, size_t corners = 3 * face_count) {
  GltfBuffer buffer;
  const int view = buffer.add_view(packed.bytes);
  const std::string points = std::to_string(packed.points);
  buffer.add_accessor("\"componentType\":5126,\"count\":" + points +
                      ",\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,2]");
  buffer.add_accessor("\"componentType\":5121,\"normalized\":true,\"count\":" + points +
                      ",\"type\":\"VEC4\"");
  buffer.add_accessor("\"componentType\":5123,\"count\":" + std::to_string(corners) +
                      ",\"type\":\"SCALAR\"");
  return buffer.as_json(
      "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"nodes\":[{\"mesh\":0}],"
      "\"meshes\":[{\"name\":\"bowl\",\"primitives\":[{\"attributes\":{\"POSITION\":0,"
      "\"COLOR_0\":1},\"indices\":2,\"extensions\":{\"KHR_draco_mesh_compression\":{"
      "\"bufferView\":" +
      std::to_string(view) + ",\"attributes\":{\"POSITION\":" + std::to_string(packed.position_id) +
      ",\"COLOR_0\":" + std::to_string(packed.color_id) + "}}}}]}]");
}

/// Corners as numbers in hundredths, faces in order of their first corner: what does not depend on
/// the order in which they were packed.
std::vector<std::vector<int>> in_order(const std::vector<std::array<Corner, 3>>& faces) {
  std::vector<std::vector<int>> all;
  for (auto face : faces) {
    const auto key = [](const Corner& corner) {
      std::vector<int> numbers;
      for (const float x : corner.position) numbers.push_back(int(std::lround(100 * x)));
      for (const uint8_t c : corner.color) numbers.push_back(c);
      return numbers;
    };
    std::rotate(face.begin(),
                std::min_element(face.begin(), face.end(),
                                 [&](const Corner& a, const Corner& b) { return key(a) < key(b); }),
                face.end());
    std::vector<int> numbers;
    for (const Corner& corner : face)
      for (const int number : key(corner)) numbers.push_back(number);
    all.push_back(numbers);
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<std::array<Corner, 3>> faces_in(const Object& shape) {
  const std::vector<float> positions = floats_of(shape, "positions"),
                           colors = floats_of(shape, "vertex_color"),
                           faces = floats_of(shape, "faces");
  std::vector<std::array<Corner, 3>> all(faces.size() / 3);
  for (size_t i = 0; i < faces.size(); ++i) {
    Corner& corner = all[i / 3][i % 3];
    for (size_t k = 0; k < 3; ++k) {
      corner.position[k] = positions.at(3 * size_t(faces[i]) + k);
      corner.color[k] = uint8_t(std::lround(255 * colors.at(3 * size_t(faces[i]) + k)));
    }
    corner.color[3] = 255;
  }
  return all;
}

TEST(GltfDraco, MeshesHaveTheFacesThatWerePacked) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Description description = parse_gltf_text(file_of(packed_bowl(method)));
    const Object& shape = only_in(*description.scene, "shape");
    ASSERT_EQ(shape.type, "mesh") << method;
    EXPECT_EQ(in_order(faces_in(shape)), in_order(bowl())) << method;
    EXPECT_FALSE(has_deviation(description, DeviationKind::missing, "bowl"));
  }
}

bool is_box(const std::string& file) {
  const Description description = parse_gltf_text(file);
  return only_in(*description.scene, "shape").type == "cube" &&
         has_deviation(description, DeviationKind::missing, "mesh 'bowl': its data, packed by");
}

TEST(GltfDraco, WhatDoesNotFitIsABox) {
  const Packed good = packed_bowl(draco::MESH_EDGEBREAKER_ENCODING);
  EXPECT_FALSE(is_box(file_of(good)));
  EXPECT_TRUE(is_box(file_of(good, 3 * face_count + 3)));
  Packed other = good;
  other.points += 1;
  EXPECT_TRUE(is_box(file_of(other)));
  other = good;
  other.color_id = 77;
  EXPECT_TRUE(is_box(file_of(other)));
  other = good;
  other.bytes.resize(good.bytes.size() / 2);
  EXPECT_TRUE(is_box(file_of(other)));
}

// A third attribute that nobody asks for, of 100 numbers: the decoder makes no room for it.
TEST(GltfDraco, AttributesOutOfProportionAreABox) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    EXPECT_FALSE(is_box(file_of(packed_bowl(method, 8)))) << method;
    EXPECT_TRUE(is_box(file_of(packed_bowl(method, 100)))) << method;
  }
}

// Each byte, and random ones: nothing but a mesh or a box comes of it.
TEST(GltfDraco, DamagedDataAreSurvived) {
  std::mt19937 random(7);
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Packed good = packed_bowl(method);
    int boxes = 0;
    for (size_t i = 0; i < good.bytes.size(); ++i) {
      Packed damaged = good;
      damaged.bytes[i] = char(random());
      if (i % 3 == 0) damaged.bytes[random() % good.bytes.size()] = char(random());
      const Description description = parse_gltf_text(file_of(damaged));
      boxes += only_in(*description.scene, "shape").type == "cube";
    }
    EXPECT_GT(boxes, 10) << method;
  }
}

}  // namespace
}  // namespace kaustik::test
