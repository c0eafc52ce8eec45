#include "kit/ply_writer.h"

#include <fmt/format.h>

#include <bit>
#include <iterator>
#include <map>

namespace kaustik::scenes {
namespace {

float rounded(double x, double step) { return float(std::round(x / step) * step) + 0.0f; }

using Record = std::vector<float>;

Record record_of(const Vertex& v, const PlyLayout& layout) {
  Record record;
  for (int axis = 0; axis < 3; ++axis) record.push_back(rounded(v.position[axis], 0x1p-16));
  if (layout.normals == Normals::stored)
    for (int axis = 0; axis < 3; ++axis) record.push_back(rounded(v.normal[axis], 0x1p-10));
  if (layout.uvs) {
    record.push_back(rounded(v.uv.x, 0x1p-12));
    record.push_back(rounded(v.uv.y, 0x1p-12));
  }
  return record;
}

bool is_degenerate(const Record& a, const Record& b, const Record& c) {
  const Vec3d p(a[0], a[1], a[2]), q(b[0], b[1], b[2]), r(c[0], c[1], c[2]);
  return (q - p).cross(r - p).length2() == 0;
}

template <typename Unsigned>
void put(std::vector<uint8_t>& bytes, Unsigned value) {
  for (size_t i = 0; i < sizeof(Unsigned); ++i) bytes.push_back(uint8_t(value >> (8 * i)));
}

std::string header(size_t vertices, size_t faces, const PlyLayout& layout, bool short_indices) {
  std::string text =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", vertices);
  const auto property = [&](const char* name) { text += fmt::format("property float {}\n", name); };
  for (const char* name : {"x", "y", "z"}) property(name);
  if (layout.normals == Normals::stored)
    for (const char* name : {"nx", "ny", "nz"}) property(name);
  if (layout.uvs)
    for (const char* name : {"u", "v"}) property(name);
  return text + fmt::format("element face {}\nproperty list uchar {} vertex_indices\nend_header\n",
                            faces, short_indices ? "ushort" : "uint");
}

}  // namespace

std::vector<uint8_t> ply_bytes(const Mesh& mesh, const PlyLayout& layout) {
  std::map<Record, uint32_t> known;
  std::vector<Record> records;
  std::vector<uint32_t> index;
  for (const Vertex& vertex : mesh.vertices) {
    Record record = record_of(vertex, layout);
    const auto [it, is_new] = known.try_emplace(record, uint32_t(records.size()));
    if (is_new) records.push_back(std::move(record));
    index.push_back(it->second);
  }
  std::vector<std::array<uint32_t, 3>> faces;
  for (const auto& [i, j, k] : mesh.triangles) {
    const uint32_t a = index[i], b = index[j], c = index[k];
    if (!is_degenerate(records[a], records[b], records[c])) faces.push_back({a, b, c});
  }
  const bool short_indices = records.size() <= 65536;
  const std::string text = header(records.size(), faces.size(), layout, short_indices);
  std::vector<uint8_t> bytes(text.begin(), text.end());
  for (const Record& record : records)
    for (const float value : record) put(bytes, std::bit_cast<uint32_t>(value));
  for (const auto& face : faces) {
    bytes.push_back(3);
    for (const uint32_t i : face) {
      if (short_indices)
        put(bytes, uint16_t(i));
      else
        put(bytes, i);
    }
  }
  return bytes;
}

}  // namespace kaustik::scenes
