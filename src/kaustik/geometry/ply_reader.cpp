// PLY: text or binary of either byte order.

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <set>
#include <span>
#include <string_view>

#include "kaustik/base/file.h"
#include "kaustik/geometry/attribute_groups.h"
#include "kaustik/geometry/mesh_attribute.h"
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

/// The number that an integer of this type stands for 1 with; 0: it is none.
double largest_of(Type type) {
  constexpr double largest[] = {0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, 0, 0};
  return largest[size_t(type)];
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

/// Attributes that are read from the properties of an element.
class AttributeReader {
 public:
  /// `whose`: "vertex_" or "face_".
  AttributeReader(const PlyElement& element, const std::string& whose) {
    std::vector<std::string> names;
    for (const PlyProperty& property : element.properties)
      names.push_back(property.is_list ? std::string() : property.name);
    for (const AttributeGroup& group : attribute_groups(names)) {
      attributes_.push_back({whose + group.name, int(group.members.size())});
      for (const size_t i : group.members)
        members_.push_back({i, largest_of(element.properties[i].type)});
    }
  }

  bool empty() const { return attributes_.empty(); }
  /// For so many elements.
  void reserve(size_t elements) {
    for (MeshAttribute& attribute : attributes_)
      attribute.values.reserve(elements * size_t(attribute.components));
  }
  /// Adds those of one element: `values` of all its properties.
  void add(const std::vector<double>& values) {
    auto member = members_.begin();
    for (MeshAttribute& attribute : attributes_)
      for (int i = 0; i < attribute.components; ++i, ++member)
        attribute.values.push_back(attribute_value(values[member->property], member->largest));
  }
  /// Moves them into the mesh; tells what is not finite.
  void finish(MeshFile& file, const std::string& path) {
    for (MeshAttribute& attribute : attributes_) {
      if (const size_t count = make_finite(attribute); count > 0)
        file.remarks.push_back(remark_on_attribute(attribute.name, count, path));
      file.mesh.attributes.push_back(std::move(attribute));
    }
    attributes_.clear();
  }

 private:
  struct Member {
    size_t property;
    double largest;  ///< see attribute_value()
  };
  std::vector<MeshAttribute> attributes_;
  std::vector<Member> members_;  ///< of all attributes in turn
};

class PlyReader {
 public:
  explicit PlyReader(const std::string& path)
      : path_(path), bytes_(read_file(path)), cutter_(bytes_.size()) {}

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
    for (AttributeReader& attributes : attributes_) attributes.finish(file, path_);
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

  void read_vertices(const PlyElement& element);
  void read_faces(const PlyElement& element);
  void read_polygon(const PlyProperty& property, uint64_t face);

  size_t left() const { return bytes_.size() - at_; }

  std::string path_;
  std::vector<uint8_t> bytes_;
  size_t at_ = 0;
  int line_ = 0;  ///< 0 in binary data
  Format format_ = Format::text;
  std::vector<PlyElement> elements_;
  std::set<std::string> element_names_;
  char line_end_ = '\n';  ///< '\r' where no '\n' follows
  TriangleMesh mesh_;
  std::vector<AttributeReader> attributes_;  ///< of the elements so far
  uint64_t vertex_count_ = 0;
  PolygonCutter cutter_;
  std::vector<uint32_t> corners_;  ///< of the face that is read
  size_t small_faces_ = 0;
};

std::vector<std::string_view> PlyReader::header_line() {
  const auto begin = bytes_.begin() + std::ptrdiff_t(at_);
  const auto end = std::find(begin, bytes_.end(), uint8_t(line_end_));
  if (end == bytes_.end())
    fail("the header has no end", "it is truncated or no PLY file: export it again");
  std::string_view line(reinterpret_cast<const char*>(bytes_.data()) + at_, size_t(end - begin));
  at_ += line.size() + 1;
  ++line_;
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
  at_ = byte_order_mark(bytes_, path_);
  const std::string_view start(reinterpret_cast<const char*>(bytes_.data()) + at_,
                               std::min<size_t>(left(), 5));
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
  while (at_ < bytes_.size() && bytes_[at_] <= ' ')
    if (bytes_[at_++] == uint8_t(line_end_)) ++line_;
  const size_t begin = at_;
  while (at_ < bytes_.size() && bytes_[at_] > ' ') ++at_;
  if (begin == at_) fail_truncated();
  const char* text = reinterpret_cast<const char*>(bytes_.data());
  const char* first = text + begin + (bytes_[begin] == '+' ? 1 : 0);
  double result = 0;
  const auto [end, error] = std::from_chars(first, text + at_, result);
  if (error == std::errc::result_out_of_range) return infinity;
  if (error != std::errc() || end != text + at_)
    fail(fmt::format("'{}' is no number",
                     std::string_view(text + begin, std::min<size_t>(at_ - begin, 40))),
         "export the file again");
  return result;
}

double PlyReader::binary_value(Type type) {
  const size_t size = size_of(type);
  if (left() < size) fail_truncated();
  uint64_t bits = 0;
  for (size_t i = 0; i < size; ++i) {
    const size_t shift = 8 * (format_ == Format::big_endian ? size - 1 - i : i);
    bits |= uint64_t(bytes_[at_ + i]) << shift;
  }
  at_ += size;
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
  at_ += size;
}

void PlyReader::read_vertices(const PlyElement& element) {
  const int position[3] = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
  const int normal[3] = {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
  const int uv[2] = {element.find({"u", "s", "texture_u"}), element.find({"v", "t", "texture_v"})};
  if (position[0] < 0 || position[1] < 0 || position[2] < 0)
    fail("the vertices have no 'x', 'y' and 'z'", "export the positions as well");
  const bool has_normals = normal[0] >= 0 && normal[1] >= 0 && normal[2] >= 0;
  const bool has_uvs = uv[0] >= 0 && uv[1] >= 0;
  vertex_count_ = element.count;
  mesh_.positions.reserve(size_t(element.count) + 1);
  if (has_normals) mesh_.normals.reserve(size_t(element.count));
  if (has_uvs) mesh_.uvs.reserve(size_t(element.count));
  AttributeReader attributes(element, "vertex_");
  attributes.reserve(size_t(element.count));
  std::vector<double> values(element.properties.size());
  for (uint64_t vertex = 0; vertex < element.count; ++vertex) {
    for (size_t i = 0; i < values.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.is_list)
        skip(property);
      else
        values[i] = value(property.type);
    }
    const auto at = [&](int i) { return float(values[size_t(i)]); };
    const Vec3f p(at(position[0]), at(position[1]), at(position[2]));
    check(fault_of_position(vertex, p));
    mesh_.positions.push_back(p);
    if (has_normals) {
      const Vec3f n(at(normal[0]), at(normal[1]), at(normal[2]));
      check(fault_of_normal(vertex, n));
      mesh_.normals.push_back(n);
    }
    if (has_uvs) {
      const Vec2f t(at(uv[0]), at(uv[1]));
      check(fault_of_uv(vertex, t));
      mesh_.uvs.push_back(t);
    }
    attributes.add(values);
  }
  attributes_.push_back(std::move(attributes));
}

void PlyReader::read_faces(const PlyElement& element) {
  const int indices = element.find({"vertex_indices", "vertex_index"});
  if (indices < 0 || !element.properties[size_t(indices)].is_list)
    fail("the faces have no list 'vertex_indices'", "export the faces as well");
  for (const PlyElement& other : elements_) {
    if (other.name == "vertex") break;
    if (&other == &element) fail("the faces come before the vertices", "export the file again");
  }
  mesh_.triangles.reserve(size_t(element.count));
  AttributeReader attributes(element, "face_");
  attributes.reserve(size_t(element.count));
  std::vector<double> values(element.properties.size());
  for (uint64_t face = 0; face < element.count; ++face) {
    const size_t triangles = mesh_.triangles.size();
    for (size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (int(i) == indices)
        read_polygon(property, face);
      else if (property.is_list || attributes.empty())
        skip(property);
      else
        values[i] = value(property.type);
    }
    // Each triangle has what its face has.
    for (size_t i = triangles; i < mesh_.triangles.size(); ++i) attributes.add(values);
  }
  attributes_.push_back(std::move(attributes));
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
