// Mitsuba's packed meshes: some of them one after the other, each a stream of zlib's behind a mark
// and a version, then the places of all, then their number.

#include <fmt/format.h>

#include <algorithm>
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
/// Of what is packed and unpacked at a time.
constexpr size_t piece_bytes = size_t{1} << 20;

enum Flags : uint32_t {
  has_normals = 1,
  has_uvs = 2,
  has_colors = 8,
  has_flat_faces = 0x10,
  in_floats = 0x1000,
  in_doubles = 0x2000
};

/// Of version 5, in the same word: what its records hold.
enum RecordFlags : uint32_t { records_normals = 1, records_frames = 2, records_uvs = 4 };
/// A vertex: its position, its normal or its shading frame, its texture coordinates.
using VertexRecord = std::array<float, 8>;
/// A face: its corners, and what Mitsuba knows of it.
using FaceRecord = std::array<uint32_t, 4>;

/// The normal of a frame that is packed into three numbers: those of its unit quaternion without
/// the real part w, over 1 + w (Terzakis, Lourakis and Ait-Boudaoud, "Modified Rodrigues
/// Parameters", JMIV 2018).
Vec3f normal_of_frame(const Vec3f& packed) {
  const float scale = 2 / (1 + dot(packed, packed));
  const Vec3f q = packed * scale;
  const float w = scale - 1;
  return {2 * (q.x * q.z + w * q.y), 2 * (q.y * q.z - w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)};
}

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
  /// Goes to the mesh with our index: files may hold thousands, so only that one is read.
  void find_mesh();
  std::vector<uint8_t> next_piece();
  /// Refuses a mesh of so many bytes if it cannot be packed into as few as it is.
  void expect(uint64_t bytes) const;

  /// The next numbers of what is unpacked.
  template <typename Number>
  void fill(std::span<Number> numbers);
  template <typename Number>
  Number next() {
    Number number;
    fill(std::span(&number, 1));
    return number;
  }
  /// Calls `take(index, record)` with the next `count` of them.
  template <typename Record, typename Take>
  void each(uint64_t count, const Take& take);
  /// Vectors of numbers in the precision of the file.
  template <typename Vector>
  void read_vectors(std::vector<Vector>& vectors, size_t spare,
                    std::optional<MeshFault> (*fault_of)(uint64_t, const Vector&));

  void read_flags_and_name();
  void read_counts();
  void read_arrays();
  void read_colors();
  void read_records();
  void read_corners();
  void check_corners(uint64_t face, const std::array<uint32_t, 3>& corners) const;

  const std::string& path_;
  uint64_t index_, size_ = 0;  ///< of the file
  uint64_t at_ = 0, end_ = 0;  ///< of what is packed and not read yet
  uint64_t packed_bytes_ = 0;
  uint32_t version_ = 0;
  Inflater inflater_{[this] { return next_piece(); }, Packing::zlib};
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
  if (version_ < 3 || version_ > 5)
    fail(fmt::format("the mesh has version {}, not 3, 4 or 5", version_),
         "save it as PLY, or with an exporter for Mitsuba 0.6 to 3");
}

void SerializedReader::find_mesh() {
  read_version(0);
  const uint64_t place_bytes = version_ == 3 ? 4 : 8;
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
    return place_bytes == 8 ? number_at<uint64_t>(places + 8 * i)
                            : number_at<uint32_t>(places + 4 * i);
  };
  const uint64_t begin = place_of(index_), end = place_of(index_ + 1);
  if (!(begin + mark_bytes < end && end <= places))
    fail_damaged(fmt::format("mesh {} lies from byte {} to {}", index_, begin, end));
  read_version(begin);
  at_ = begin + mark_bytes;
  end_ = end;
  packed_bytes_ = end_ - at_;
}

std::vector<uint8_t> SerializedReader::next_piece() {
  const auto most = size_t(std::min<uint64_t>(piece_bytes, end_ - at_));
  if (most == 0) return {};
  std::vector<uint8_t> bytes = read_file_part(path_, at_, most).bytes;
  at_ += bytes.size();
  return bytes;
}

void SerializedReader::expect(uint64_t bytes) const {
  if (bytes > always_allowed_bytes + usual_growth * packed_bytes_)
    fail_damaged(
        fmt::format("mesh {} would grow from {} to {} bytes", index_, packed_bytes_, bytes));
}

template <typename Number>
void SerializedReader::fill(std::span<Number> numbers) {
  const std::span<uint8_t> bytes(reinterpret_cast<uint8_t*>(numbers.data()), numbers.size_bytes());
  if (inflater_.fill(bytes) < bytes.size())
    fail_damaged(fmt::format("mesh {} ends too early", index_));
}

template <typename Record, typename Take>
void SerializedReader::each(uint64_t count, const Take& take) {
  std::vector<Record> piece(size_t(std::min<uint64_t>(count, piece_bytes / sizeof(Record))));
  for (uint64_t first = 0; first < count; first += piece.size()) {
    const size_t some = size_t(std::min<uint64_t>(piece.size(), count - first));
    fill(std::span(piece).first(some));
    for (size_t i = 0; i < some; ++i) take(first + i, piece[i]);
  }
}

void SerializedReader::read_flags_and_name() {
  flags_ = next<uint32_t>();
  if (version_ == 4) {
    // It ends with a zero.
    size_t length = 0;
    while (next<char>() != 0)
      if (++length > longest_name)
        fail_damaged(fmt::format("the name of mesh {} has no end", index_));
  } else if (version_ == 5) {
    const auto length = next<uint32_t>();
    if (length > longest_name)
      fail_damaged(fmt::format("the name of mesh {} has {} letters", index_, length));
    each<char>(length, [](uint64_t, char) {});
  }
}

void SerializedReader::read_counts() {
  vertices_ = next<uint64_t>();
  triangles_ = next<uint64_t>();
  check(fault_of_count(vertices_, "vertex"));
  check(fault_of_count(triangles_, "triangle"));
}

template <typename Vector>
void SerializedReader::read_vectors(std::vector<Vector>& vectors, size_t spare,
                                    std::optional<MeshFault> (*fault_of)(uint64_t, const Vector&)) {
  constexpr size_t numbers = sizeof(Vector) / sizeof(float);
  reserve_large(vectors, size_t(vertices_) + spare);
  if (flags_ & in_doubles) {
    each<std::array<double, numbers>>(vertices_, [&](uint64_t, const auto& given) {
      Vector& vector = vectors.emplace_back();
      for (size_t i = 0; i < numbers; ++i) vector[int(i)] = float(given[i]);
    });
  } else {
    vectors.resize(size_t(vertices_));
    fill(std::span(vectors));
  }
  if (are_finite(std::span<const Vector>(vectors))) return;
  for (size_t i = 0; i < vectors.size(); ++i) check(fault_of(i, vectors[i]));
}

void SerializedReader::check_corners(uint64_t face, const std::array<uint32_t, 3>& corners) const {
  for (const uint32_t corner : corners)
    check(fault_of_index(face, corner, vertices_, "the file is damaged: export it again"));
}

void SerializedReader::read_corners() {
  TriangleList& triangles = result_.mesh.triangles;
  triangles.resize(size_t(triangles_));
  fill(std::span(triangles));
  uint32_t largest = 0;
  for (const auto& corners : triangles)
    largest = std::max({largest, corners[0], corners[1], corners[2]});
  if (largest < vertices_) return;
  for (size_t face = 0; face < triangles.size(); ++face) check_corners(face, triangles[face]);
}

/// Versions 3 and 4: all positions, then all normals, and so on.
void SerializedReader::read_arrays() {
  read_counts();
  const uint64_t values = 3 + (flags_ & has_normals ? 3 : 0) + (flags_ & has_uvs ? 2 : 0) +
                          (flags_ & has_colors ? 3 : 0);
  expect(vertices_ * values * (flags_ & in_doubles ? 8 : 4) + triangles_ * 12);
  TriangleMesh& mesh = result_.mesh;
  read_vectors(mesh.positions, 1, fault_of_position);  // one to spare: see MeshShape
  if (flags_ & has_normals) read_vectors(mesh.normals, 0, fault_of_normal);
  if (flags_ & has_uvs) read_vectors(mesh.uvs, 0, fault_of_uv);
  if (flags_ & has_colors) read_colors();
  reserve_large(mesh.triangles, size_t(triangles_));
  read_corners();
}

void SerializedReader::read_colors() {
  MeshAttribute attribute{"vertex_color", 3};
  std::vector<float>& values = attribute.values;
  values.resize(3 * size_t(vertices_));
  if (flags_ & in_doubles)
    each<double>(values.size(),
                 [&](uint64_t i, double value) { values[size_t(i)] = float(value); });
  else
    fill(std::span(values));
  if (const size_t count = make_finite(attribute); count > 0)
    result_.remarks.push_back(remark_on_attribute(attribute.name, count, path_));
  result_.mesh.attributes.push_back(std::move(attribute));
}

/// Version 5: records of vertices, then of faces. Which vertices once were one, and attributes, are
/// left out.
void SerializedReader::read_records() {
  if (!(flags_ & in_floats))
    fail_damaged(fmt::format("the numbers of mesh {} are no single floats", index_));
  read_counts();
  for (const char* kind : {"position", "normal"})
    if (const auto count = next<uint64_t>(); count > vertices_)
      fail_damaged(
          fmt::format("mesh {} has {} vertices, and {} {}s", index_, vertices_, count, kind));
  expect(vertices_ * sizeof(VertexRecord) + triangles_ * sizeof(FaceRecord));
  TriangleMesh& mesh = result_.mesh;
  const bool frames = (flags_ & records_frames) != 0;
  const bool normals = (flags_ & records_normals) != 0, uvs = (flags_ & records_uvs) != 0;
  reserve_large(mesh.positions, size_t(vertices_) + 1);
  if (normals) reserve_large(mesh.normals, size_t(vertices_));
  if (uvs) reserve_large(mesh.uvs, size_t(vertices_));
  each<VertexRecord>(vertices_, [&](uint64_t i, const VertexRecord& record) {
    mesh.positions.emplace_back(record[0], record[1], record[2]);
    check(fault_of_position(i, mesh.positions.back()));
    if (normals) {
      const Vec3f given(record[3], record[4], record[5]);
      mesh.normals.push_back(frames ? normal_of_frame(given) : given);
      check(fault_of_normal(i, mesh.normals.back()));
    }
    if (uvs) {
      mesh.uvs.emplace_back(record[6], record[7]);
      check(fault_of_uv(i, mesh.uvs.back()));
    }
  });
  reserve_large(mesh.triangles, size_t(triangles_));
  each<FaceRecord>(triangles_, [&](uint64_t face, const FaceRecord& record) {
    check_corners(face, mesh.triangles.emplace_back(std::array{record[0], record[1], record[2]}));
  });
}

MeshFile SerializedReader::read() {
  find_mesh();
  read_flags_and_name();
  if (version_ == 5)
    read_records();
  else
    read_arrays();
  if (triangles_ == 0) check(fault_of_no_faces());
  result_.has_face_normals = (flags_ & has_flat_faces) != 0;
  return std::move(result_);
}

}  // namespace

MeshFile read_serialized(const std::string& path, uint64_t shape_index) {
  return SerializedReader(path, shape_index).read();
}

}  // namespace kaustik
