// PLY: text or binary of either byte order.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <memory>
#include <span>
#include <string_view>

#include "kaustik/base/parallel.h"
#include "kaustik/base/polygon_cutter.h"
#include "kaustik/geometry/file_window.h"
#include "kaustik/geometry/mesh_checks.h"
#include "kaustik/geometry/mesh_reader.h"
#include "kaustik/geometry/ply_attributes.h"
#include "kaustik/geometry/ply_header.h"
#include "kaustik/geometry/ply_values.h"

namespace kaustik {
namespace {

/// Of the file, that are read at a time: they and what they become stay in a core's cache.
constexpr size_t bytes_at_once = size_t{1} << 18;

/// Attributes of faces take more than their bytes in the file, once for each triangle: a dozen
/// times as much where polygons have dozens of corners.
constexpr uint64_t usual_attribute_growth = 20, always_allowed_attribute_bytes = uint64_t{64} << 20;

/// Those with the given numbers.
template <size_t count>
std::array<PlyField, count> fields_at(const std::vector<PlyField>& fields,
                                      const std::array<int, count>& numbers) {
  std::array<PlyField, count> some;
  for (size_t i = 0; i < count; ++i) some[i] = fields[size_t(numbers[i])];
  return some;
}

class PlyReader {
 public:
  explicit PlyReader(const std::string& path)
      : path_(path),
        file_(InputFile::unpacked(path)),
        window_(file_),
        header_(read_ply_header(path, window_)),
        line_(is_text() ? header_.lines + 1 : 0),
        cutter_(size_t(file_.size())) {}

  MeshFile read() {
    for (const PlyElement& element : header_.elements) {
      check_count(element);
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else
        for (uint64_t i = 0; i < element.count; ++i) skip(element);
    }
    if (mesh_.triangles.empty()) check(fault_of_no_faces());
    MeshFile file{std::move(mesh_), {}};
    if (small_faces_ > 0) file.remarks.push_back(remark_on_small_faces(small_faces_, path_));
    for (PlyAttributes& attributes : attributes_) attributes.finish(file, path_);
    return file;
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    fail_in_ply(path_, line_, what, remedy);
  }
  bool is_text() const { return header_.format == PlyFormat::text; }
  bool is_big_endian() const { return header_.format == PlyFormat::big_endian; }
  void check(const std::optional<MeshFault>& fault) const {
    if (fault) fail(fault->message, fault->remedy);
  }
  [[noreturn]] void fail_truncated() const {
    fail("the file ends too early", "it is truncated: export or copy it again");
  }

  // Values -------------------------------------------------------------------------------------
  void check_count(const PlyElement& element) const;
  double value(PlyType type) { return is_text() ? text_value() : binary_value(type); }
  double text_value();
  double binary_value(PlyType type);
  uint64_t list_size(const PlyProperty& property);
  void skip(const PlyProperty& property);
  void skip(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) skip(property);
  }

  // Vertices -----------------------------------------------------------------------------------
  /// Which property of a vertex each number of it is; −1: none.
  struct VertexLayout {
    std::array<int, 3> position, normal;
    std::array<int, 2> uv;
    bool has_normals, has_uvs;
  };
  static VertexLayout layout_of(const PlyElement& element);
  void read_vertices(const PlyElement& element);
  void read_vertex(const PlyElement& element, const VertexLayout& layout, uint64_t vertex,
                   std::vector<double>& values);
  bool read_vertex_block(const PlyElement& element, const VertexLayout& layout,
                         PlyAttributes& attributes);
  void check_vertex(uint64_t vertex) const;

  // Faces --------------------------------------------------------------------------------------
  void read_faces(const PlyElement& element);
  bool read_triangle_block(const PlyElement& element, size_t indices, PlyAttributes& attributes);
  void read_polygons(const PlyElement& element, size_t indices, PlyAttributes& attributes);
  void read_polygon(const PlyProperty& property, uint64_t face);
  void check_growth(const PlyAttributes& attributes, uint64_t face) const;

  /// Calls body(first, bytes) for all records of an element with so many bytes each, in parallel
  /// and in pieces; `first` is the number of the piece's first record. False if the file is too
  /// short; otherwise it is read on behind them.
  template <typename Body>
  bool each_piece(uint64_t count, size_t record_bytes, const Body& body);

  std::optional<std::vector<PlyField>> fields_of(const PlyElement& element,
                                                 int triangles = -1) const;
  static size_t record_bytes_of(const std::vector<PlyField>& fields) {
    return fields.back().offset;
  }

  uint64_t left() const { return window_.left(); }

  std::string path_;
  InputFile file_;
  FileWindow window_;
  PlyHeader header_;
  int line_;  ///< 0 in binary data
  TriangleMesh mesh_;
  std::vector<PlyAttributes> attributes_;  ///< of the elements so far
  uint64_t vertex_count_ = 0;
  PolygonCutter cutter_;
  std::vector<uint32_t> corners_;  ///< of the face that is read
  size_t small_faces_ = 0;
};

/// Nothing is allocated by what a header says before the rest of the file could hold it.
void PlyReader::check_count(const PlyElement& element) const {
  uint64_t smallest = 0;  // bytes of one element
  for (const PlyProperty& property : element.properties)
    smallest += is_text() ? 2 : size_of(property.is_list ? property.count_type : property.type);
  if (smallest == 0 && element.count > 0)
    fail(fmt::format("element '{}' has no properties", element.name), "export the file again");
  // The last value of a text file needs no blank behind it.
  if (element.count > 0 && element.count > (left() + 1) / smallest)
    fail(fmt::format("the header announces {} elements '{}', more than the file can hold",
                     element.count, element.name),
         "it is truncated: export or copy it again");
  check(fault_of_count(element.count, element.name));
}

double PlyReader::text_value() {
  constexpr size_t longest = 4096;  // far more digits than a number has
  std::span<const uint8_t> ahead = window_.ahead(1);
  while (!ahead.empty() && ahead[0] <= ' ') {
    size_t blanks = 0;
    for (; blanks < ahead.size() && ahead[blanks] <= ' '; ++blanks)
      if (ahead[blanks] == uint8_t(header_.line_end)) ++line_;
    window_.advance(blanks);
    ahead = window_.ahead(1);
  }
  if (ahead.empty()) fail_truncated();
  const auto end_of_word = [&] {
    return size_t(std::find_if(ahead.begin(), ahead.end(), [](uint8_t c) { return c <= ' '; }) -
                  ahead.begin());
  };
  size_t length = end_of_word();
  if (length == ahead.size()) {
    ahead = window_.ahead(longest);
    length = end_of_word();
  }
  const bool is_too_long = length == ahead.size() && window_.left() > length;
  const std::string_view word(reinterpret_cast<const char*>(ahead.data()), length);
  const char* first = word.data() + (word[0] == '+' ? 1 : 0);
  double result = 0;
  const auto [end, error] = std::from_chars(first, word.data() + length, result);
  if (is_too_long || (error != std::errc::result_out_of_range &&
                      (error != std::errc() || end != word.data() + length)))
    fail(fmt::format("'{}' is no number", word.substr(0, 40)), "export the file again");
  window_.advance(length);
  return error == std::errc() ? result : double(infinity);
}

double PlyReader::binary_value(PlyType type) {
  const size_t size = size_of(type);
  const std::span<const uint8_t> ahead = window_.ahead(size);
  if (ahead.size() < size) fail_truncated();
  const double result = value_at(ahead.data(), type, is_big_endian());
  window_.advance(size);
  return result;
}

uint64_t PlyReader::list_size(const PlyProperty& property) {
  const double count = value(property.count_type);
  if (!(count >= 0) || count != std::floor(count))
    fail(fmt::format("a list '{}' has the length {}", property.name, count),
         "the file is damaged: export it again");
  const double smallest = is_text() ? 2.0 : double(size_of(property.type));
  if (count * smallest > double(left() + 1)) fail_truncated();
  return uint64_t(count);
}

void PlyReader::skip(const PlyProperty& property) {
  const uint64_t count = property.is_list ? list_size(property) : 1;
  if (is_text()) {
    for (uint64_t i = 0; i < count; ++i) text_value();
    return;
  }
  const uint64_t size = count * size_of(property.type);
  if (size > left()) fail_truncated();
  if (window_.ahead(1).size() >= size)
    window_.advance(size_t(size));
  else
    window_.move_to(window_.position() + size);
}

template <typename Body>
bool PlyReader::each_piece(uint64_t count, size_t record_bytes, const Body& body) {
  const uint64_t begin = window_.position();
  if (count > left() / record_bytes) return false;
  const size_t block = std::max<size_t>(1, bytes_at_once / record_bytes);
  std::atomic<bool> is_short{false};
  parallel_blocks(size_t(count), block, [&](size_t first, size_t end, size_t) {
    const size_t size = (end - first) * record_bytes;
    // Not zeroed: it is written over at once.
    const std::unique_ptr<uint8_t[]> bytes(new uint8_t[size]);
    if (file_.read(begin + first * record_bytes, {bytes.get(), size}) < size)
      is_short = true;
    else
      body(first, PlyRecords{{bytes.get(), size}, record_bytes, is_big_endian()});
  });
  if (is_short) return false;
  window_.move_to(begin + count * record_bytes);
  return true;
}

/// Where the properties lie in the records of an element, and behind them the end of a record;
/// nothing where records differ in size. `triangles`: a list that is taken to have three numbers,
/// by its length; −1: none.
std::optional<std::vector<PlyField>> PlyReader::fields_of(const PlyElement& element,
                                                          int triangles) const {
  if (is_text() || element.count == 0) return std::nullopt;
  std::vector<PlyField> fields;
  size_t offset = 0;
  for (const PlyProperty& property : element.properties) {
    if (property.is_list && int(fields.size()) != triangles) return std::nullopt;
    fields.push_back({offset, property.is_list ? property.count_type : property.type});
    offset += property.is_list ? size_of(property.count_type) + 3 * size_of(property.type)
                               : size_of(property.type);
  }
  fields.push_back({offset});
  return fields;
}

PlyReader::VertexLayout PlyReader::layout_of(const PlyElement& element) {
  VertexLayout layout{};
  layout.position = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
  layout.normal = {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
  layout.uv = {element.find({"u", "s", "texture_u"}), element.find({"v", "t", "texture_v"})};
  const auto has = [](const auto& indices) {
    return std::all_of(indices.begin(), indices.end(), [](int i) { return i >= 0; });
  };
  layout.has_normals = has(layout.normal);
  layout.has_uvs = has(layout.uv);
  return layout;
}

void PlyReader::check_vertex(uint64_t vertex) const {
  const auto i = size_t(vertex);
  check(fault_of_position(vertex, mesh_.positions[i]));
  if (!mesh_.normals.empty()) check(fault_of_normal(vertex, mesh_.normals[i]));
  if (!mesh_.uvs.empty()) check(fault_of_uv(vertex, mesh_.uvs[i]));
}

void PlyReader::read_vertices(const PlyElement& element) {
  const VertexLayout layout = layout_of(element);
  if (layout.position[0] < 0 || layout.position[1] < 0 || layout.position[2] < 0)
    fail("the vertices have no 'x', 'y' and 'z'", "export the positions as well");
  vertex_count_ = element.count;
  reserve_large(mesh_.positions, size_t(element.count) + 1);  // see MeshShape
  if (layout.has_normals) reserve_large(mesh_.normals, size_t(element.count));
  if (layout.has_uvs) reserve_large(mesh_.uvs, size_t(element.count));
  PlyAttributes attributes(element, "vertex_");
  if (!read_vertex_block(element, layout, attributes)) {
    attributes.reserve(size_t(element.count));
    std::vector<double> values(element.properties.size());
    for (uint64_t vertex = 0; vertex < element.count; ++vertex) {
      read_vertex(element, layout, vertex, values);
      attributes.add([&](size_t property) { return values[property]; });
    }
  }
  attributes_.push_back(std::move(attributes));
}

void PlyReader::read_vertex(const PlyElement& element, const VertexLayout& layout, uint64_t vertex,
                            std::vector<double>& values) {
  for (size_t i = 0; i < values.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.is_list)
      skip(property);
    else
      values[i] = value(property.type);
  }
  const auto at = [&](int i) { return float(values[size_t(i)]); };
  const auto& [x, y, z] = layout.position;
  mesh_.positions.emplace_back(at(x), at(y), at(z));
  if (layout.has_normals) {
    const auto& [nx, ny, nz] = layout.normal;
    mesh_.normals.emplace_back(at(nx), at(ny), at(nz));
  }
  if (layout.has_uvs) mesh_.uvs.emplace_back(at(layout.uv[0]), at(layout.uv[1]));
  check_vertex(vertex);
}

/// All at once and in parallel, if their records have the same size; false: they do not.
bool PlyReader::read_vertex_block(const PlyElement& element, const VertexLayout& layout,
                                  PlyAttributes& attributes) {
  const auto fields = fields_of(element);
  if (!fields) return false;
  const auto count = size_t(element.count);
  mesh_.positions.resize(count);
  if (layout.has_normals) mesh_.normals.resize(count);
  if (layout.has_uvs) mesh_.uvs.resize(count);
  attributes.resize(count);
  std::atomic<size_t> first_fault{count};  // the first of a piece that has one
  const auto read_piece = [&](size_t first, const PlyRecords& records) {
    const auto is_sound = [&](auto& vectors, const auto& properties) {
      return copy_vectors(records, fields_at(*fields, properties), vectors.data() + first);
    };
    bool sound = is_sound(mesh_.positions, layout.position);
    if (layout.has_normals) sound &= is_sound(mesh_.normals, layout.normal);
    if (layout.has_uvs) sound &= is_sound(mesh_.uvs, layout.uv);
    attributes.set_all(first, records, *fields);
    size_t known = first_fault;
    while (!sound && first < known && !first_fault.compare_exchange_weak(known, first)) {
    }
  };
  if (!each_piece(element.count, record_bytes_of(*fields), read_piece)) fail_truncated();
  for (size_t i = first_fault; i < count; ++i) check_vertex(i);
  return true;
}

void PlyReader::read_faces(const PlyElement& element) {
  const int indices = element.find({"vertex_indices", "vertex_index"});
  if (indices < 0 || !element.properties[size_t(indices)].is_list)
    fail("the faces have no list 'vertex_indices'", "export the faces as well");
  for (const PlyElement& other : header_.elements) {
    if (other.name == "vertex") break;
    if (&other == &element) fail("the faces come before the vertices", "export the file again");
  }
  reserve_large(mesh_.triangles, size_t(element.count));
  PlyAttributes attributes(element, "face_");
  if (!read_triangle_block(element, size_t(indices), attributes))
    read_polygons(element, size_t(indices), attributes);
  attributes_.push_back(std::move(attributes));
}

void PlyReader::read_polygons(const PlyElement& element, size_t indices,
                              PlyAttributes& attributes) {
  attributes.reserve(size_t(element.count));
  std::vector<double> values(element.properties.size());
  for (uint64_t face = 0; face < element.count; ++face) {
    const size_t triangles = mesh_.triangles.size();
    for (size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (i == indices)
        read_polygon(property, face);
      else if (property.is_list || attributes.empty())
        skip(property);
      else
        values[i] = value(property.type);
    }
    check_growth(attributes, face);
    // Each triangle has what its face has.
    for (size_t i = triangles; i < mesh_.triangles.size(); ++i)
      attributes.add([&](size_t property) { return values[property]; });
  }
}

/// All at once and in parallel, if they are triangles and have no other lists; false, and nothing
/// read: they are or have.
bool PlyReader::read_triangle_block(const PlyElement& element, size_t indices,
                                    PlyAttributes& attributes) {
  const auto fields = fields_of(element, int(indices));
  if (!fields || element.count > left() / record_bytes_of(*fields)) return false;
  const PlyField& length = (*fields)[indices];
  // Other polygons are mostly told by the first one, before memory is taken.
  const std::span<const uint8_t> ahead = window_.ahead(length.offset + size_of(length.type));
  if (value_at(ahead.data() + length.offset, length.type, is_big_endian()) != 3) return false;
  mesh_.triangles.resize(size_t(element.count));
  attributes.resize(size_t(element.count));
  // What is wrong is told by reading face by face.
  std::atomic<bool> is_sound{true};
  const auto read_piece = [&](size_t first, const PlyRecords& records) {
    if (!copy_corners(records, length, element.properties[indices].type, vertex_count_,
                      mesh_.triangles.data() + first))
      is_sound = false;
    attributes.set_all(first, records, *fields);
  };
  const uint64_t begin = window_.position();
  if (each_piece(element.count, record_bytes_of(*fields), read_piece) && is_sound) return true;
  mesh_.triangles.clear();
  attributes.resize(0);
  window_.move_to(begin);
  return false;
}

/// A file that has many attributes and large polygons could ask for a number of values that goes
/// with the square of its size.
void PlyReader::check_growth(const PlyAttributes& attributes, uint64_t face) const {
  const uint64_t values = attributes.values_of_element() * mesh_.triangles.size();
  if (values * sizeof(float) >
      always_allowed_attribute_bytes + usual_attribute_growth * file_.size())
    fail(fmt::format("the attributes of faces up to face {}, one of each for every triangle, are "
                     "{} numbers",
                     face, values),
         "export the mesh as triangles, or without attributes of faces");
}

void PlyReader::read_polygon(const PlyProperty& property, uint64_t face) {
  const uint64_t corners = list_size(property);
  corners_.clear();
  const auto add = [&](double index) {
    check(fault_of_index(face, index, vertex_count_, "the file is damaged: export it again"));
    corners_.push_back(uint32_t(index));
  };
  if (is_text()) {
    for (uint64_t i = 0; i < corners; ++i) add(text_value());
  } else {
    const size_t index_bytes = size_of(property.type), size = size_t(corners) * index_bytes;
    const std::span<const uint8_t> ahead = window_.ahead(size);
    if (ahead.size() < size) fail_truncated();
    for (size_t i = 0; i < size; i += index_bytes)
      add(value_at(ahead.data() + i, property.type, is_big_endian()));
    window_.advance(size);
  }
  if (corners_.size() < 3)
    ++small_faces_;
  else if (!cutter_.cut(mesh_.positions, corners_, corners_, mesh_.triangles))
    fail(fmt::format("face {} with {} corners takes too long to be cut into triangles", face,
                     corners),
         "export the mesh as triangles");
}

}  // namespace

MeshFile read_ply(const std::string& path) { return PlyReader(path).read(); }

}  // namespace kaustik
