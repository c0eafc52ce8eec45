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

inline std::string packed_mesh(const PackedMesh& mesh, uint16_t version) {
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
  uLongf size = compressBound(uLong(raw.size()));
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
           uLong(raw.size()));
  out.resize(size);
  std::string whole;
  put_bytes(whole, uint16_t(0x041c));
  put_bytes(whole, version);
  return whole + packed(raw);
}

/// Of version 3 or 4.
inline std::string serialized_file(const std::vector<PackedMesh>& meshes, uint16_t version) {
  std::string out;
  std::vector<uint64_t> places;
  for (const PackedMesh& mesh : meshes) {
    places.push_back(out.size());
    out += packed_mesh(mesh, version);
  }
  for (const uint64_t place : places)
    if (version == 4)
      put_bytes(out, place);
    else
      put_bytes(out, uint32_t(place));
  put_bytes(out, uint32_t(meshes.size()));
  return out;
}

}  // namespace kaustik::test
