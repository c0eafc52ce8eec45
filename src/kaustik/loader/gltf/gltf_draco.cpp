#include "kaustik/loader/gltf/gltf_draco.h"

#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>

#include <cstring>
#include <memory>
#include <new>

namespace kaustik::gltf {
namespace {

constexpr unsigned sequential = 0, edgebreaker = 1;
constexpr size_t method_at = 8;

bool is_sequential(std::span<const std::byte> packed) {
  return std::to_integer<unsigned>(packed[method_at]) == sequential;
}

/// What stands before the packed data (Draco bitstream 2.2, sections 4 to 6).
class DracoHead {
 public:
  explicit DracoHead(std::span<const std::byte> bytes) : rest_(bytes) {}

  /// Whether a mesh follows whose counts are those: the decoder makes room for what they say.
  bool fits(const DracoMesh& mesh) {
    constexpr char mark[] = {'D', 'R', 'A', 'C', 'O'};
    constexpr size_t head_bytes = 11;
    constexpr unsigned triangles = 1, metadata_flag = 0x80;
    if (rest_.size() < head_bytes || std::memcmp(rest_.data(), mark, sizeof(mark)) != 0)
      return false;
    const auto byte = [&](size_t at) { return std::to_integer<unsigned>(rest_[at]); };
    const unsigned kind = byte(7), method = byte(method_at);
    if (byte(5) != 2 || byte(6) != 2 || kind != triangles || (byte(10) & metadata_flag) != 0)
      return false;
    // The kind of traversal follows where edges are broken.
    if (method > edgebreaker || rest_.size() < head_bytes + 1) return false;
    rest_ = rest_.subspan(head_bytes + (method == edgebreaker ? 1 : 0));
    const uint64_t first = next_number(), second = next_number();
    if (method == sequential) return 3 * first == mesh.corners && second == mesh.vertices;
    if (rest_.empty()) return false;
    rest_ = rest_.subspan(1);  // how many attributes have seams of their own
    const uint64_t symbols = next_number(), splits = next_number();
    // Seams split vertices: there may be more of them than were packed.
    return 3 * second == mesh.corners && first <= mesh.vertices && symbols <= second &&
           splits <= symbols;
  }

 private:
  /// Of seven bits a byte, the lowest first; beyond all counts where it does not end.
  uint64_t next_number() {
    uint64_t number = 0;
    for (int shift = 0; shift < 35 && !rest_.empty(); shift += 7) {
      const auto byte = std::to_integer<uint64_t>(rest_.front());
      rest_ = rest_.subspan(1);
      number |= (byte & 0x7f) << shift;
      if (byte < 0x80) return number;
    }
    return uint64_t{1} << 40;
  }

  std::span<const std::byte> rest_;
};

/// A decoder that makes no room for attributes that take more than so many bytes of a vertex: a few
/// bytes of packed data may ask for thousands.
template <typename Decoder>
class BoundedDecoder : public Decoder {
 public:
  explicit BoundedDecoder(size_t most_vertex_bytes) : most_vertex_bytes_(most_vertex_bytes) {}

 private:
  /// The attributes are known by then, but have no values yet.
  bool DecodeAllAttributes() override {
    const draco::PointCloud& mesh = *this->point_cloud();
    size_t vertex_bytes = 0;
    for (int i = 0; i < mesh.num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *mesh.attribute(i);
      vertex_bytes +=
          size_t(attribute.num_components()) * size_t(draco::DataTypeLength(attribute.data_type()));
    }
    return vertex_bytes <= most_vertex_bytes_ && Decoder::DecodeAllAttributes();
  }

  size_t most_vertex_bytes_;
};

template <typename Decoder>
std::unique_ptr<draco::Mesh> decoded_by(std::span<const std::byte> packed,
                                        size_t most_vertex_bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(packed.data()), packed.size());
  auto mesh = std::make_unique<draco::Mesh>();
  BoundedDecoder<Decoder> decoder(most_vertex_bytes);
  const bool is_whole = decoder.Decode(draco::DecoderOptions(), &buffer, mesh.get()).ok();
  return is_whole ? std::move(mesh) : nullptr;
}

bool take_values(const draco::Mesh& from, DracoMesh::Attribute& attribute) {
  const draco::PointAttribute* packed = from.GetAttributeByUniqueId(attribute.id);
  if (!packed || size_t(packed->num_components()) != attribute.components) return false;
  const float scale = packed->normalized() ? 1 : attribute.scale;
  attribute.values.resize(from.num_points() * attribute.components);
  for (uint32_t i = 0; i < from.num_points(); ++i) {
    float* const to = &attribute.values[i * attribute.components];
    if (!packed->ConvertValue<float>(packed->mapped_index(draco::PointIndex(i)),
                                     int8_t(attribute.components), to))
      return false;
    for (size_t k = 0; k < attribute.components; ++k) to[k] *= scale;
  }
  return true;
}

}  // namespace

bool unpack_draco(std::span<const std::byte> packed, DracoMesh& mesh) try {
  if (!DracoHead(packed).fits(mesh)) return false;
  const auto decoded = is_sequential(packed) ? decoded_by<draco::MeshSequentialDecoder>
                                             : decoded_by<draco::MeshEdgebreakerDecoder>;
  const std::unique_ptr<draco::Mesh> found = decoded(packed, mesh.most_vertex_bytes());
  if (!found) return false;
  if (found->num_points() != mesh.vertices || 3 * size_t(found->num_faces()) != mesh.corners)
    return false;
  for (DracoMesh::Attribute& attribute : mesh.attributes)
    if (!take_values(*found, attribute)) return false;
  mesh.faces.reserve(mesh.corners);
  for (draco::FaceIndex i(0); i < found->num_faces(); ++i)
    for (const draco::PointIndex& corner : found->face(i)) mesh.faces.push_back(corner.value());
  return true;
} catch (const std::bad_alloc&) {
  return false;
}

}  // namespace kaustik::gltf
