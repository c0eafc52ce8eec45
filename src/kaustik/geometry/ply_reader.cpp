// PLY: text or binary of either byte order.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <charconv>
#include <cstring>
#include <memory>
#include <set>
#include <span>
#include <string_view>

#include "kaustik/base/parallel.h"
#include "kaustik/base/text_lines.h"
#include "kaustik/geometry/file_window.h"
#include "kaustik/geometry/mesh_checks.h"
#include "kaustik/geometry/mesh_reader.h"
#include "kaustik/geometry/polygon_cutter.h"

namespace kaustik {
namespace {

enum class Format { text, little_endian, big_endian };
enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

size_t size_of(Type type) {
  constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[size_t(type)];
}

std::optional<Type> type_named(std::string_view name) {
  constexpr std::pair<std::string_view, Type> names[] = {
      {"char", Type::int8},      {"int8", Type::int8},       {"uchar", Type::uint8},
      {"uint8", Type::uint8},    {"short", Type::int16},     {"int16", Type::int16},
      {"ushort", Type::uint16},  {"uint16", Type::uint16},   {"int", Type::int32},
      {"int32", Type::int32},    {"uint", Type::uint32},     {"uint32", Type::uint32},
      {"float", Type::float32},  {"float32", Type::float32}, {"double", Type::float64},
      {"float64", Type::float64}};
  for (const auto& [text, type] : names)
    if (text == name) return type;
  return std::nullopt;
}

/// The number of a type that begins at `bytes`.
double value_at(const uint8_t* bytes, Type type, bool big_endian) {
  const size_t size = size_of(type);
  uint64_t bits = 0;
  for (size_t i = 0; i < size; ++i)
    bits |= uint64_t(bytes[i]) << (8 * (big_endian ? size - 1 - i : i));
  switch (type) {
    case Type::int8:
      return int8_t(bits);
    case Type::uint8:
      return uint8_t(bits);
    case Type::int16:
      return int16_t(bits);
    case Type::uint16:
      return uint16_t(bits);
    case Type::int32:
      return int32_t(bits);
    case Type::uint32:
      return uint32_t(bits);
    case Type::float32:
      return double(std::bit_cast<float>(uint32_t(bits)));
    case Type::float64:
      return std::bit_cast<double>(bits);
  }
  return 0;
}

struct PlyProperty {
  std::string name;
  bool is_list = false;
  Type count_type = Type::uint8;  ///< of lists
  Type type = Type::float32;
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  int find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view wanted : names)
      for (size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == wanted) return int(i);
    return -1;
  }
};

class PlyReader {
 public:
  explicit PlyReader(const std::string& path)
      : path_(path), file_(path), window_(file_), cutter_(size_t(file_.size())) {}

  MeshFile read() {
    read_header();
    for (const PlyElement& element : elements_) {
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
    return file;
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorKind::input, "PLY: " + what, remedy, place_in(path_, line_));
  }
  void check(const std::optional<MeshFault>& fault) const {
    if (fault) fail(fault->message, fault->remedy);
  }
  [[noreturn]] void fail_truncated() const {
    fail("the file ends too early", "it is truncated: export or copy it again");
  }

  // Header -------------------------------------------------------------------------------------
  std::vector<std::string_view> header_line();
  void read_header();
  void header_element(const std::vector<std::string_view>& words);
  void header_property(const std::vector<std::string_view>& words);
  void check_count(const PlyElement& element) const;

  // Values -------------------------------------------------------------------------------------
  double value(Type type) { return format_ == Format::text ? text_value() : binary_value(type); }
  double text_value();
  double binary_value(Type type);
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
                   std::vector<float>& values);
  bool read_vertex_block(const PlyElement& element, const VertexLayout& layout);
  void check_vertex(uint64_t vertex) const;

  // Faces --------------------------------------------------------------------------------------
  void read_faces(const PlyElement& element);
  bool read_triangle_block(const PlyElement& element, size_t indices);
  void read_polygon(const PlyProperty& property, uint64_t face);

  /// Calls body(first, bytes) for all records of an element with so many bytes each, in parallel
  /// and in pieces; `first` is the number of the piece's first record. False if the file is too
  /// short; otherwise it is read on behind them.
  template <typename Body>
  bool each_piece(uint64_t count, size_t record_bytes, const Body& body);

  uint64_t left() const { return window_.left(); }

  std::string path_;
  InputFile file_;
  FileWindow window_;
  int line_ = 0;  ///< 0 in binary data
  Format format_ = Format::text;
  std::vector<PlyElement> elements_;
  std::set<std::string> element_names_;
  char line_end_ = '\n';  ///< '\r' where no '\n' follows
  std::string header_line_;
  TriangleMesh mesh_;
  uint64_t vertex_count_ = 0;
  PolygonCutter cutter_;
  std::vector<uint32_t> corners_;  ///< of the face that is read
  size_t small_faces_ = 0;
};

std::vector<std::string_view> PlyReader::header_line() {
  constexpr size_t longest = 1 << 16;
  const std::span<const uint8_t> ahead = window_.ahead(longest);
  const auto end = std::find(ahead.begin(), ahead.end(), uint8_t(line_end_));
  if (end == ahead.end())
    fail("the header has no end", "it is truncated or no PLY file: export it again");
  header_line_.assign(ahead.begin(), end);
  window_.advance(header_line_.size() + 1);
  ++line_;
  const std::string_view line = header_line_;
  std::vector<std::string_view> words;
  constexpr std::string_view blanks = " \t\r";
  for (size_t i = line.find_first_not_of(blanks); i != line.npos;
       i = line.find_first_not_of(blanks, i)) {
    const size_t stop = std::min(line.find_first_of(blanks, i), line.size());
    words.push_back(line.substr(i, stop - i));
    i = stop;
  }
  return words;
}

void PlyReader::read_header() {
  window_.advance(length_of_byte_order_mark(window_.ahead(3), path_));
  const std::span<const uint8_t> ahead = window_.ahead(5);
  const std::string start(ahead.begin(),
                          ahead.begin() + std::ptrdiff_t(std::min<size_t>(ahead.size(), 5)));
  line_ = 1;
  if (!start.starts_with("ply")) fail("the file does not start with 'ply'", "give a PLY file");
  line_ = 0;
  // How the first line ends tells how all of them do.
  if (start.size() == 5 && start[3] == '\r' && start[4] != '\n') line_end_ = '\r';
  header_line();
  bool has_format = false;
  while (true) {
    const auto words = header_line();
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() == 3) {
      if (words[1] == "ascii")
        format_ = Format::text;
      else if (words[1] == "binary_little_endian")
        format_ = Format::little_endian;
      else if (words[1] == "binary_big_endian")
        format_ = Format::big_endian;
      else
        fail(fmt::format("unknown format '{}'", words[1]),
             "valid: ascii, binary_little_endian, binary_big_endian");
      has_format = true;
    } else if (words[0] == "element") {
      header_element(words);
    } else if (words[0] == "property") {
      header_property(words);
    } else {
      fail(fmt::format("the header has an unknown line '{}'", words[0]), "export the file again");
    }
  }
  if (!has_format) fail("the header has no 'format' line", "export the file again");
  line_ = format_ == Format::text ? line_ + 1 : 0;
}

void PlyReader::header_element(const std::vector<std::string_view>& words) {
  PlyElement element;
  if (words.size() != 3) fail("'element' needs a name and a number", "export the file again");
  element.name = words[1];
  const auto [end, error] =
      std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
  if (error != std::errc() || end != words[2].data() + words[2].size())
    fail(fmt::format("'{}' is no number of elements", words[2]), "export the file again");
  if (!element_names_.insert(element.name).second)
    fail(fmt::format("element '{}' is there twice", element.name.substr(0, 40)),
         "export the file again");
  elements_.push_back(std::move(element));
}

void PlyReader::header_property(const std::vector<std::string_view>& words) {
  if (elements_.empty()) fail("a property comes before any element", "export the file again");
  PlyProperty property;
  property.is_list = words.size() == 5 && words[1] == "list";
  if (!property.is_list && words.size() != 3)
    fail("a property needs a type and a name", "export the file again");
  const auto type = [&](std::string_view name) {
    const auto found = type_named(name);
    if (!found)
      fail(fmt::format("unknown type '{}'", name),
           "valid: char, uchar, short, ushort, int, uint, float, double");
    return *found;
  };
  if (property.is_list) property.count_type = type(words[2]);
  property.type = type(words[words.size() - 2]);
  property.name = words.back();
  elements_.back().properties.push_back(std::move(property));
}

/// Nothing is allocated by what a header says before the rest of the file could hold it.
void PlyReader::check_count(const PlyElement& element) const {
  uint64_t smallest = 0;  // bytes of one element
  for (const PlyProperty& property : element.properties)
    smallest += format_ == Format::text
                    ? 2
                    : size_of(property.is_list ? property.count_type : property.type);
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
      if (ahead[blanks] == uint8_t(line_end_)) ++line_;
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

double PlyReader::binary_value(Type type) {
  const size_t size = size_of(type);
  const std::span<const uint8_t> ahead = window_.ahead(size);
  if (ahead.size() < size) fail_truncated();
  const double result = value_at(ahead.data(), type, format_ == Format::big_endian);
  window_.advance(size);
  return result;
}

uint64_t PlyReader::list_size(const PlyProperty& property) {
  const double count = value(property.count_type);
  if (!(count >= 0) || count != std::floor(count))
    fail(fmt::format("a list '{}' has the length {}", property.name, count),
         "the file is damaged: export it again");
  const double smallest = format_ == Format::text ? 2.0 : double(size_of(property.type));
  if (count * smallest > double(left() + 1)) fail_truncated();
  return uint64_t(count);
}

void PlyReader::skip(const PlyProperty& property) {
  const uint64_t count = property.is_list ? list_size(property) : 1;
  if (format_ == Format::text) {
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
  const size_t block = std::max<size_t>(1, (size_t{1} << 19) / record_bytes);
  std::vector<char> is_short((count + block - 1) / block, 0);
  parallel_blocks(size_t(count), block, [&](size_t first, size_t end, size_t piece) {
    const size_t size = (end - first) * record_bytes;
    // Not zeroed: it is written over at once.
    const std::unique_ptr<uint8_t[]> bytes(new uint8_t[size]);
    if (file_.read(begin + first * record_bytes, {bytes.get(), size}) < size)
      is_short[piece] = 1;
    else
      body(first, std::span<const uint8_t>(bytes.get(), size));
  });
  if (std::find(is_short.begin(), is_short.end(), 1) != is_short.end()) return false;
  window_.move_to(begin + count * record_bytes);
  return true;
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
  mesh_.positions.reserve(size_t(element.count) + 1);  // see MeshShape
  if (layout.has_normals) mesh_.normals.reserve(size_t(element.count));
  if (layout.has_uvs) mesh_.uvs.reserve(size_t(element.count));
  if (read_vertex_block(element, layout)) return;
  std::vector<float> values(element.properties.size());
  for (uint64_t vertex = 0; vertex < element.count; ++vertex)
    read_vertex(element, layout, vertex, values);
}

void PlyReader::read_vertex(const PlyElement& element, const VertexLayout& layout, uint64_t vertex,
                            std::vector<float>& values) {
  for (size_t i = 0; i < values.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.is_list)
      skip(property);
    else
      values[i] = float(value(property.type));
  }
  const auto at = [&](int i) { return values[size_t(i)]; };
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
bool PlyReader::read_vertex_block(const PlyElement& element, const VertexLayout& layout) {
  if (format_ == Format::text || element.count == 0) return false;
  std::vector<size_t> offsets;
  size_t record_bytes = 0;
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) return false;
    offsets.push_back(record_bytes);
    record_bytes += size_of(property.type);
  }
  const auto count = size_t(element.count);
  mesh_.positions.resize(count);
  if (layout.has_normals) mesh_.normals.resize(count);
  if (layout.has_uvs) mesh_.uvs.resize(count);
  const bool big_endian = format_ == Format::big_endian;
  const auto number = [&](const uint8_t* record, int index) {
    const Type type = element.properties[size_t(index)].type;
    const uint8_t* bytes = record + offsets[size_t(index)];
    if (type != Type::float32 || big_endian) return float(value_at(bytes, type, big_endian));
    float value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
  };
  std::atomic<size_t> first_fault{count};
  const auto is_sound = [&](size_t i) {
    return is_finite(mesh_.positions[i]) && (!layout.has_normals || is_finite(mesh_.normals[i])) &&
           (!layout.has_uvs || (std::isfinite(mesh_.uvs[i].x) && std::isfinite(mesh_.uvs[i].y)));
  };
  const auto read_piece = [&](size_t first, std::span<const uint8_t> bytes) {
    const uint8_t* record = bytes.data();
    for (size_t i = first; i < first + bytes.size() / record_bytes; ++i, record += record_bytes) {
      const auto fill = [&](auto& vector, const auto& indices) {
        for (size_t axis = 0; axis < indices.size(); ++axis)
          vector[int(axis)] = number(record, indices[axis]);
      };
      fill(mesh_.positions[i], layout.position);
      if (layout.has_normals) fill(mesh_.normals[i], layout.normal);
      if (layout.has_uvs) fill(mesh_.uvs[i], layout.uv);
      if (is_sound(i)) [[likely]]
        continue;
      size_t known = first_fault;
      while (i < known && !first_fault.compare_exchange_weak(known, i)) {
      }
    }
  };
  if (!each_piece(element.count, record_bytes, read_piece)) fail_truncated();
  if (first_fault < count) check_vertex(first_fault);
  return true;
}

void PlyReader::read_faces(const PlyElement& element) {
  const int indices = element.find({"vertex_indices", "vertex_index"});
  if (indices < 0 || !element.properties[size_t(indices)].is_list)
    fail("the faces have no list 'vertex_indices'", "export the faces as well");
  for (const PlyElement& other : elements_) {
    if (other.name == "vertex") break;
    if (&other == &element) fail("the faces come before the vertices", "export the file again");
  }
  if (read_triangle_block(element, size_t(indices))) return;
  mesh_.triangles.reserve(size_t(element.count));
  for (uint64_t face = 0; face < element.count; ++face)
    for (size_t i = 0; i < element.properties.size(); ++i)
      if (int(i) == indices)
        read_polygon(element.properties[i], face);
      else
        skip(element.properties[i]);
}

/// All at once and in parallel, if they are triangles and have no other lists; false, and nothing
/// read: they are or have.
bool PlyReader::read_triangle_block(const PlyElement& element, size_t indices) {
  if (format_ == Format::text || element.count == 0) return false;
  const bool big_endian = format_ == Format::big_endian;
  const PlyProperty& list = element.properties[indices];
  const size_t count_bytes = size_of(list.count_type), index_bytes = size_of(list.type);
  size_t before = 0, record_bytes = 0;
  for (size_t i = 0; i < element.properties.size(); ++i) {
    if (i == indices) {
      before = record_bytes;
      record_bytes += count_bytes + 3 * index_bytes;
    } else if (element.properties[i].is_list) {
      return false;
    } else {
      record_bytes += size_of(element.properties[i].type);
    }
  }
  const uint64_t begin = window_.position();
  const std::span<const uint8_t> first_face = window_.ahead(record_bytes);
  if (element.count > left() / record_bytes || first_face.size() < record_bytes ||
      value_at(first_face.data() + before, list.count_type, big_endian) != 3)
    return false;
  const bool is_plain = !big_endian && (list.type == Type::int32 || list.type == Type::uint32);
  mesh_.triangles.resize(size_t(element.count));
  // What is wrong is told by reading face by face.
  std::atomic<bool> is_sound{true};
  const auto read_piece = [&](size_t first, std::span<const uint8_t> bytes) {
    const uint8_t* record = bytes.data() + before;
    bool sound = true;
    for (size_t i = first; i < first + bytes.size() / record_bytes; ++i, record += record_bytes) {
      std::array<uint32_t, 3>& corners = mesh_.triangles[i];
      const uint8_t* from = record + count_bytes;
      sound = sound && (count_bytes == 1 ? *record == 3
                                         : value_at(record, list.count_type, big_endian) == 3);
      if (is_plain) {
        std::memcpy(corners.data(), from, sizeof(corners));
        sound = sound && std::max({corners[0], corners[1], corners[2]}) < vertex_count_;
        continue;
      }
      for (uint32_t& corner : corners) {
        const double index = value_at(from, list.type, big_endian);
        const bool is_index =
            index >= 0 && index < double(vertex_count_) && index == std::floor(index);
        sound = sound && is_index;
        corner = is_index ? uint32_t(index) : 0;
        from += index_bytes;
      }
    }
    if (!sound) is_sound = false;
  };
  if (each_piece(element.count, record_bytes, read_piece) && is_sound) return true;
  mesh_.triangles.clear();
  window_.move_to(begin);
  return false;
}

void PlyReader::read_polygon(const PlyProperty& property, uint64_t face) {
  const uint64_t corners = list_size(property);
  corners_.clear();
  for (uint64_t i = 0; i < corners; ++i) {
    const double index = value(property.type);
    check(fault_of_index(face, index, vertex_count_, "the file is damaged: export it again"));
    corners_.push_back(uint32_t(index));
  }
  if (corners_.size() < 3)
    ++small_faces_;
  else if (!cutter_.cut(mesh_.positions, corners_, mesh_.triangles))
    fail(fmt::format("face {} with {} corners takes too long to be cut into triangles", face,
                     corners),
         "export the mesh as triangles");
}

}  // namespace

MeshFile read_ply(const std::string& path) { return PlyReader(path).read(); }

}  // namespace kaustik
