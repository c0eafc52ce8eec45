// Wavefront OBJ, read here rather than by a library for its messages: line numbers, and numbers
// that are none must not become zero.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>
#include <unordered_map>

#include "kaustik/base/file.h"
#include "kaustik/base/sampler.h"
#include "kaustik/base/srgb.h"
#include "kaustik/geometry/mesh_attribute.h"
#include "kaustik/geometry/mesh_checks.h"
#include "kaustik/geometry/mesh_reader.h"
#include "kaustik/geometry/polygon_cutter.h"

namespace kaustik {
namespace {

constexpr uint32_t none = 0xffffffffu;

/// Which position, texture coordinate and normal one corner of a face uses.
struct CornerKey {
  uint32_t position = none, uv = none, normal = none;
  friend bool operator==(const CornerKey&, const CornerKey&) = default;
};
struct CornerHash {
  size_t operator()(const CornerKey& key) const {
    return size_t(hash_mix((uint64_t(key.position) << 32) | key.uv, key.normal));
  }
};

class ObjReader {
 public:
  explicit ObjReader(const std::string& path)
      : path_(path), bytes_(read_file(path)), cutter_(bytes_.size()) {}

  MeshFile read() {
    at_ = byte_order_mark(bytes_, path_);
    while (at_ < bytes_.size()) read_line(next_line());
    if (mesh_.triangles.empty()) {
      line_ = 0;
      const MeshFault fault = fault_of_no_faces();
      fail(fault.message, fault.remedy);
    }
    finish();
    return {std::move(mesh_), std::move(remarks_)};
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorKind::input, "OBJ: " + what, remedy, place_in(path_, line_));
  }

  /// For a message. A scene may name any file: words are shown once there is a vertex in it.
  std::string_view quotable(std::string_view word) const {
    return positions_.empty() ? "…" : word.substr(0, 40);
  }

  std::string_view next_line();
  std::string_view next_part();
  void read_line(std::string_view line);
  void remark_unknown(const std::string& keyword);
  static size_t count_words(std::string_view line);
  void set_colour(size_t position, const Vec3f& encoded);
  /// Returns what follows them.
  std::string_view read_numbers(std::string_view line, std::string_view what, float* values,
                                int count) const;
  void read_face(std::string_view line);
  CornerKey read_corner(std::string_view word) const;
  uint32_t read_index(std::string_view text, size_t count, std::string_view what) const;
  uint32_t vertex_of(const CornerKey& key);
  void add_colours();
  void finish();

  static std::string_view next_word(std::string_view& line) {
    constexpr std::string_view blanks = " \t\r";
    const size_t begin = std::min(line.find_first_not_of(blanks), line.size());
    const size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
  }

  std::string path_;
  std::vector<uint8_t> bytes_;
  size_t at_ = 0;
  int line_ = 1;        ///< on which the line that is read begins
  int parts_ = 0;       ///< over how many lines of the file it goes
  std::string joined_;  ///< the line, where it goes on
  size_t faces_ = 0;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec3f> colours_;  ///< of the positions, as far as there are any
  std::vector<Vec2f> uvs_;
  std::unordered_map<CornerKey, uint32_t, CornerHash> vertices_;
  TriangleMesh mesh_;
  PolygonCutter cutter_;
  std::vector<uint32_t> corners_;  ///< of the face that is read
  size_t small_faces_ = 0;
  std::set<std::string> unknown_;
  std::vector<std::string> remarks_;
  bool any_uv_ = false, any_normal_ = false;
};

/// Up to the end of the line, which any system may have written.
std::string_view ObjReader::next_part() {
  const std::string_view rest(reinterpret_cast<const char*>(bytes_.data()) + at_,
                              bytes_.size() - at_);
  const size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
  at_ += std::min(end + (rest.substr(end, 2) == "\r\n" ? 2 : 1), rest.size());
  ++parts_;
  return rest.substr(0, end);
}

/// A line; one that ends with a backslash goes on in the next one.
std::string_view ObjReader::next_line() {
  line_ += parts_;
  parts_ = 0;
  std::string_view part = next_part();
  if (!part.ends_with('\\')) return part;
  joined_.clear();
  for (; part.ends_with('\\'); part = next_part()) {
    joined_.append(part.substr(0, part.size() - 1));
    joined_.push_back(' ');
  }
  joined_.append(part);
  return joined_;
}

/// What says nothing about the faces, or about points and lines alone.
bool is_skipped(std::string_view keyword) {
  constexpr std::string_view known[] = {"g",        "o",        "s",          "mg",        "usemtl",
                                        "mtllib",   "usemap",   "maplib",     "lod",       "bevel",
                                        "c_interp", "d_interp", "shadow_obj", "trace_obj", "l",
                                        "p",        "vp"};
  return keyword.empty() || keyword[0] == '#' ||
         std::find(std::begin(known), std::end(known), keyword) != std::end(known);
}

void ObjReader::remark_unknown(const std::string& keyword) {
  constexpr size_t most = 5;
  const std::string given = keyword.substr(0, 40);
  if (unknown_.size() >= most || !unknown_.insert(given).second) return;
  remarks_.push_back(fmt::format(
      "{}:{}: lines that begin with '{}' are skipped: OBJ files of faces have none{}", path_, line_,
      given, unknown_.size() == most ? "; there may be more such lines" : ""));
}

void ObjReader::read_line(std::string_view line) {
  std::string keyword(next_word(line));
  for (char& c : keyword)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  float values[6] = {0, 0, 0, 0, 0, 0};
  if (keyword == "v") {
    const std::string name = fmt::format("vertex {}", positions_.size() + 1);
    // After the position may stand a weight, or a colour.
    const std::string_view rest = read_numbers(line, name, values, 3);
    if (count_words(rest) >= 3) {
      read_numbers(rest, name, values + 3, 3);
      set_colour(positions_.size(), {values[3], values[4], values[5]});
    }
    positions_.emplace_back(values[0], values[1], values[2]);
  } else if (keyword == "vn") {
    read_numbers(line, fmt::format("normal {}", normals_.size() + 1), values, 3);
    normals_.emplace_back(values[0], values[1], values[2]);
  } else if (keyword == "vt") {
    // v may be missing in textures of one dimension.
    std::string_view rest = line;
    next_word(rest);
    const bool has_v = !next_word(rest).empty();
    read_numbers(line, fmt::format("texture coordinate {}", uvs_.size() + 1), values,
                 has_v ? 2 : 1);
    uvs_.emplace_back(values[0], values[1]);
  } else if (keyword == "f") {
    read_face(line);
  } else if (!is_skipped(keyword)) {
    remark_unknown(keyword);
  }
}

size_t ObjReader::count_words(std::string_view line) {
  size_t count = 0;
  for (std::string_view word = next_word(line); !word.empty() && word[0] != '#';
       word = next_word(line))
    ++count;
  return count;
}

/// Those that have none before are white. Colours are sRGB encoded, as MeshLab and Blender write
/// them.
void ObjReader::set_colour(size_t position, const Vec3f& encoded) {
  colours_.resize(position, Vec3f(1));
  colours_.emplace_back(linear_from_srgb(encoded.x), linear_from_srgb(encoded.y),
                        linear_from_srgb(encoded.z));
}

std::string_view ObjReader::read_numbers(std::string_view line, std::string_view what,
                                         float* values, int count) const {
  for (int i = 0; i < count; ++i) {
    std::string_view word = next_word(line);
    const std::string_view given = quotable(word);
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || end != word.data() + word.size())
      fail(fmt::format("{}: '{}' is no number", what, given), "it takes numbers between blanks");
    values[i] = float(value);
    if (error != std::errc() || !std::isfinite(values[i]))
      fail(fmt::format("{} is not finite ('{}')", what, given),
           "repair the mesh: all coordinates must be numbers");
  }
  return line;
}

void ObjReader::read_face(std::string_view line) {
  ++faces_;
  corners_.clear();
  for (std::string_view word = next_word(line); !word.empty() && word[0] != '#';
       word = next_word(line))
    corners_.push_back(vertex_of(read_corner(word)));
  if (corners_.size() < 3)
    ++small_faces_;
  else if (!cutter_.cut(mesh_.positions, corners_, mesh_.triangles))
    fail(fmt::format("face {} with {} corners takes too long to be cut into triangles", faces_,
                     corners_.size()),
         "export the mesh as triangles");
}

CornerKey ObjReader::read_corner(std::string_view word) const {
  // "position", "position/uv", "position//normal" or "position/uv/normal"
  CornerKey key;
  const size_t slash = word.find('/');
  key.position = read_index(word.substr(0, slash), positions_.size(), "vertex");
  if (slash == word.npos) return key;
  const std::string_view rest = word.substr(slash + 1);
  const size_t second = rest.find('/');
  const std::string_view uv = rest.substr(0, second);
  if (!uv.empty()) key.uv = read_index(uv, uvs_.size(), "texture coordinate");
  if (second != rest.npos && second + 1 < rest.size())
    key.normal = read_index(rest.substr(second + 1), normals_.size(), "normal");
  return key;
}

/// Counts from 1; negative: back from the last one so far.
uint32_t ObjReader::read_index(std::string_view text, size_t count, std::string_view what) const {
  int64_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc() || end != text.data() + text.size())
    fail(fmt::format("face {}: '{}' is no index", faces_, quotable(text)),
         "corners are written 1, 1/2, 1//3 or 1/2/3");
  const int64_t from_zero = index > 0 ? index - 1 : int64_t(count) + index;
  if (index == 0 || from_zero < 0 || from_zero >= int64_t(count))
    fail(fmt::format("face {} refers to {} {} of {}", faces_, what, index, count),
         "indices count from 1, or back from -1, over what comes before the face");
  return uint32_t(from_zero);
}

uint32_t ObjReader::vertex_of(const CornerKey& key) {
  const auto [it, is_new] = vertices_.try_emplace(key, uint32_t(mesh_.positions.size()));
  if (!is_new) return it->second;
  if (mesh_.positions.size() >= none - 1) fail("the mesh has too many vertices", "split the mesh");
  mesh_.positions.push_back(positions_[key.position]);
  mesh_.uvs.push_back(key.uv != none ? uvs_[key.uv] : Vec2f(0, 0));
  mesh_.normals.push_back(key.normal != none ? normals_[key.normal] : Vec3f(0, 0, 0));
  any_uv_ |= key.uv != none;
  any_normal_ |= key.normal != none;
  return it->second;
}

void ObjReader::add_colours() {
  if (colours_.empty()) return;
  MeshAttribute attribute{"vertex_color", 3};
  attribute.values.resize(3 * mesh_.positions.size());
  for (const auto& [key, vertex] : vertices_) {
    const Vec3f colour = key.position < colours_.size() ? colours_[key.position] : Vec3f(1);
    for (int c = 0; c < 3; ++c) attribute.values[3 * size_t(vertex) + size_t(c)] = colour[c];
  }
  if (const size_t count = make_finite(attribute); count > 0)
    remarks_.push_back(remark_on_attribute(attribute.name, count, path_));
  mesh_.attributes.push_back(std::move(attribute));
}

void ObjReader::finish() {
  if (!any_uv_) mesh_.uvs.clear();
  if (!any_normal_) mesh_.normals.clear();
  add_colours();
  if (small_faces_ > 0) remarks_.push_back(remark_on_small_faces(small_faces_, path_));
}

}  // namespace

MeshFile read_obj(const std::string& path) { return ObjReader(path).read(); }

}  // namespace kaustik
