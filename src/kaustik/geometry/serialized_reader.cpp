// Mitsuba's packed meshes: some of them one after the other, each a stream of zlib's behind a mark
// and a version, then the places of all, then their number.

#include <fmt/format.h>

#include <cstring>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/base/inflate.h"
#include "kaustik/geometry/mesh_attribute.h"
#include "kaustik/geometry/mesh_checks.h"
#include "kaustik/geometry/mesh_reader.h"

namespace kaustik {
namespace {

constexpr uint16_t mark = 0x041c;
constexpr size_t mark_bytes = 4;  ///< with the version
/// Meshes are packed to a half or a tenth. Small ones may grow beyond that.
constexpr uint64_t usual_growth = 100, always_allowed_bytes = uint64_t{64} << 20;
constexpr size_t longest_name = 1 << 16;

enum Flags : uint32_t {
  has_normals = 1,
  has_uvs = 2,
  has_tangents = 4,
  has_colors = 8,
  has_flat_faces = 0x10,
  in_doubles = 0x2000
};

class SerializedReader {
 public:
  SerializedReader(const std::string& path, uint64_t index) : path_(path), index_(index) {}

  MeshFile read();

 private:
  [[noreturn]] void fail(const std::string& message, const std::string& remedy) const {
    throw Error(ErrorKind::input, message, remedy, place_in(path_));
  }
  [[noreturn]] void fail_damaged(const std::string& what) const {
    fail(what, "the file is damaged or truncated: copy or export it again");
  }
  void check(const std::optional<MeshFault>& fault) const {
    if (fault) fail(fault->message, fault->remedy);
  }

  /// A number of the file, in the order of bytes of the machines that it is made for.
  template <typename Number>
  Number number_at(uint64_t offset) {
    const FilePart part = read_file_part(path_, offset, sizeof(Number));
    size_ = part.file_size;
    if (part.bytes.size() < sizeof(Number)) fail_damaged("the file ends too early");
    Number number;
    std::memcpy(&number, part.bytes.data(), sizeof(Number));
    return number;
  }
  void read_version(uint64_t offset);
  /// The packed bytes of the mesh with our index: files may hold thousands, so only these are read.
  std::vector<uint8_t> read_stream();
  void unpack(std::span<const uint8_t> packed);

  /// The next number of what was unpacked.
  template <typename Number>
  Number next() {
    Number number;
    std::memcpy(&number, unpacked_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    return number;
  }
  float next_value() { return flags_ & in_doubles ? float(next<double>()) : next<float>(); }
  Vec3f next_vector() {
    const float x = next_value(), y = next_value();
    return {x, y, next_value()};
  }
  void read_vertices();
  void read_colors();
  void read_triangles();

  const std::string& path_;
  uint64_t index_, size_ = 0;  ///< of the file
  uint32_t version_ = 0;
  std::vector<uint8_t> unpacked_;
  size_t at_ = 0;  ///< in unpacked_
  uint32_t flags_ = 0;
  uint64_t vertices_ = 0, triangles_ = 0;
  MeshFile result_;
};

void SerializedReader::read_version(uint64_t offset) {
  const auto found = number_at<uint32_t>(offset);
  if ((found & 0xffff) != mark)
    fail(fmt::format("no mesh of Mitsuba's begins at byte {}", offset),
         "name a file of Mitsuba's format 'serialized', or the type of this file");
  version_ = found >> 16;
  if (version_ != 3 && version_ != 4)
    fail(fmt::format("the mesh has version {}, not 3 or 4", version_),
         "save it as PLY, or with an exporter for Mitsuba 0.6 to 3");
}

std::vector<uint8_t> SerializedReader::read_stream() {
  read_version(0);
  const uint64_t place_bytes = version_ == 4 ? 8 : 4;
  const uint64_t count = size_ < 8 ? 0 : number_at<uint32_t>(size_ - 4);
  if (count == 0 || count > (size_ - 4) / place_bytes)
    fail_damaged(fmt::format("the file says that it holds {} meshes", count));
  if (index_ >= count)
    fail(fmt::format("there is no mesh {}", index_),
         count == 1 ? "the file holds one, with index 0"
                    : fmt::format("the file holds {}, counted from 0", count));
  const uint64_t places = size_ - 4 - count * place_bytes;
  const auto place_of = [&](uint64_t i) -> uint64_t {
    if (i == count) return places;
    return version_ == 4 ? number_at<uint64_t>(places + 8 * i)
                         : number_at<uint32_t>(places + 4 * i);
  };
  const uint64_t begin = place_of(index_), end = place_of(index_ + 1);
  if (!(begin + mark_bytes < end && end <= places))
    fail_damaged(fmt::format("mesh {} lies from byte {} to {}", index_, begin, end));
  read_version(begin);
  return read_file_part(path_, begin + mark_bytes, size_t(end - begin - mark_bytes)).bytes;
}

void SerializedReader::unpack(std::span<const uint8_t> packed) {
  Inflater inflater(packed, Packing::zlib);
  const auto need = [&](uint64_t bytes) {
    if (bytes > always_allowed_bytes + usual_growth * packed.size())
      fail_damaged(
          fmt::format("mesh {} would grow from {} to {} bytes", index_, packed.size(), bytes));
    inflater.unpack(unpacked_, size_t(bytes));
    if (unpacked_.size() < bytes) fail_damaged(fmt::format("mesh {} ends too early", index_));
  };
  need(sizeof(flags_));
  flags_ = next<uint32_t>();
  // Version 4 has a name here, which ends with a zero.
  const auto next_letter = [&] { return need(at_ + 1), next<char>(); };
  if (version_ == 4)
    while (next_letter() != 0)
      if (at_ > longest_name) fail_damaged(fmt::format("the name of mesh {} has no end", index_));
  need(at_ + 16);
  vertices_ = next<uint64_t>();
  triangles_ = next<uint64_t>();
  check(fault_of_count(vertices_, "vertex"));
  check(fault_of_count(triangles_, "triangle"));
  const uint64_t values = 3 + (flags_ & has_normals ? 3 : 0) + (flags_ & has_uvs ? 2 : 0) +
                          (flags_ & has_colors ? 3 : 0);
  need(at_ + vertices_ * values * (flags_ & in_doubles ? 8 : 4) + triangles_ * 12);
}

void SerializedReader::read_vertices() {
  TriangleMesh& mesh = result_.mesh;
  mesh.positions.reserve(size_t(vertices_));
  for (uint64_t i = 0; i < vertices_; ++i) {
    mesh.positions.push_back(next_vector());
    check(fault_of_position(i, mesh.positions.back()));
  }
  if (flags_ & has_normals) {
    mesh.normals.reserve(size_t(vertices_));
    for (uint64_t i = 0; i < vertices_; ++i) {
      mesh.normals.push_back(next_vector());
      check(fault_of_normal(i, mesh.normals.back()));
    }
  }
  if (flags_ & has_uvs) {
    mesh.uvs.reserve(size_t(vertices_));
    for (uint64_t i = 0; i < vertices_; ++i) {
      const float u = next_value();
      mesh.uvs.push_back({u, next_value()});
      check(fault_of_uv(i, mesh.uvs.back()));
    }
  }
  if (flags_ & has_colors) read_colors();
}

void SerializedReader::read_colors() {
  MeshAttribute attribute{"vertex_color", 3};
  attribute.values.reserve(3 * size_t(vertices_));
  for (uint64_t i = 0; i < 3 * vertices_; ++i) attribute.values.push_back(next_value());
  if (const size_t count = make_finite(attribute); count > 0)
    result_.remarks.push_back(remark_on_attribute(attribute.name, count, path_));
  result_.mesh.attributes.push_back(std::move(attribute));
}

void SerializedReader::read_triangles() {
  result_.mesh.triangles.reserve(size_t(triangles_));
  for (uint64_t face = 0; face < triangles_; ++face) {
    std::array<uint32_t, 3> corners{};
    for (uint32_t& corner : corners) {
      corner = next<uint32_t>();
      check(fault_of_index(face, corner, vertices_, "the file is damaged: export it again"));
    }
    result_.mesh.triangles.push_back(corners);
  }
}

MeshFile SerializedReader::read() {
  unpack(read_stream());
  read_vertices();
  read_triangles();
  if (triangles_ == 0) check(fault_of_no_faces());
  result_.has_face_normals = (flags_ & has_flat_faces) != 0;
  return std::move(result_);
}

}  // namespace

MeshFile read_serialized(const std::string& path, uint64_t shape_index) {
  return SerializedReader(path, shape_index).read();
}

}  // namespace kaustik
