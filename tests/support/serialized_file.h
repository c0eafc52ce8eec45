#pragma once
// Mitsuba's packed meshes, written.

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace kaustik::test {

template <typename T>
void put_bytes(std::string& out, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  out.append(raw, sizeof(T));
}

inline std::string packed(const std::string& raw) {
  uLongf size = compressBound(uLong(raw.size()));
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
           uLong(raw.size()));
  out.resize(size);
  return out;
}

/// A mesh as Mitsuba packs it.
struct PackedMesh {
  uint32_t flags = 0;
  std::string name = "a mesh";
  std::vector<std::vector<double>> arrays;  ///< positions, and what the flags promise
  std::vector<uint32_t> corners;
};

/// The records of version 5: vertices of eight floats, faces of three corners and a word.
struct RecordMesh {
  uint32_t flags = 0x1000;
  std::vector<float> vertices;
  std::vector<uint32_t> corners;
  bool has_maps = false;
};

inline std::string raw_records(const RecordMesh& mesh, const std::string& name) {
  std::string raw;
  put_bytes(raw, mesh.flags);
  put_bytes(raw, uint32_t(name.size()));
  raw += name;
  const uint64_t vertices = mesh.vertices.size() / 8;
  put_bytes(raw, vertices);
  put_bytes(raw, uint64_t(mesh.corners.size() / 3));
  for (int i = 0; i < 2; ++i) put_bytes(raw, mesh.has_maps ? vertices : uint64_t(0));
  for (const float value : mesh.vertices) put_bytes(raw, value);
  for (size_t i = 0; i < mesh.corners.size(); ++i) {
    put_bytes(raw, mesh.corners[i]);
    if (i % 3 == 2) put_bytes(raw, uint32_t(0x80000000));
  }
  if (mesh.has_maps)
    for (uint64_t i = 0; i < 2 * vertices; ++i) put_bytes(raw, uint32_t(i % vertices));
  put_bytes(raw, uint32_t(0));  // attributes
  return raw;
}

/// A triangle with normals and texture coordinates.
inline RecordMesh record_mesh() {
  return {.flags = 0x1000 | 1 | 4,
          .vertices = {0, 0, 2, 0, 0, 1, 0, 0,  //
                       1, 0, 2, 0, 0, 1, 1, 0,  //
                       0, 1, 2, 0, 0, 1, 0, 1},
          .corners = {0, 1, 2}};
}

inline std::string raw_arrays(const PackedMesh& mesh, uint16_t version) {
  std::string raw;
  put_bytes(raw, mesh.flags);
  if (version == 4) raw.append(mesh.name).push_back('\0');
  put_bytes(raw, uint64_t(mesh.arrays[0].size() / 3));
  put_bytes(raw, uint64_t(mesh.corners.size() / 3));
  for (const auto& array : mesh.arrays)
    for (const double value : array)
      if (mesh.flags & 0x2000)
        put_bytes(raw, value);
      else
        put_bytes(raw, float(value));
  for (const uint32_t corner : mesh.corners) put_bytes(raw, corner);
  return raw;
}

/// Streams one after the other, as files of that version hold them.
inline std::string serialized_streams(const std::vector<std::string>& raw, uint16_t version) {
  std::string out;
  std::vector<uint64_t> places;
  for (const std::string& stream : raw) {
    places.push_back(out.size());
    put_bytes(out, uint16_t(0x041c));
    put_bytes(out, version);
    out += packed(stream);
  }
  for (const uint64_t place : places)
    if (version == 3)
      put_bytes(out, uint32_t(place));
    else
      put_bytes(out, place);
  put_bytes(out, uint32_t(raw.size()));
  return out;
}

/// Of version 3 or 4.
inline std::string serialized_file(const std::vector<PackedMesh>& meshes, uint16_t version) {
  std::vector<std::string> raw;
  for (const PackedMesh& mesh : meshes) raw.push_back(raw_arrays(mesh, version));
  return serialized_streams(raw, version);
}
/// Of version 5.
inline std::string serialized_file(const std::vector<RecordMesh>& meshes) {
  std::vector<std::string> raw;
  for (const RecordMesh& mesh : meshes) raw.push_back(raw_records(mesh, "a mesh"));
  return serialized_streams(raw, 5);
}

}  // namespace kaustik::test
