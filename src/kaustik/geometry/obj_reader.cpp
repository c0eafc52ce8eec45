// Wavefront OBJ, read here rather than by a library for its messages: line numbers, and numbers
// that are none must not become zero.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>
#include <unordered_map>

#include "kaustik/base/sampler.h"
#include "kaustik/base/srgb.h"
#include "kaustik/base/text_lines.h"
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

/// The vertex that each corner becomes: those of a position are few, and looked through one after
/// another; only where they are many they are hashed.
class VertexTable {
 public:
  /// The vertex of a corner; `next` where the corner is new.
  uint32_t vertex_of(const CornerKey& key, uint32_t next) {
    if (key.position >= first_.size()) first_.resize(size_t(key.position) + 1, none);
    uint32_t* link = &first_[key.position];
    for (int i = 0; *link != none; ++i) {
      if (keys_[*link] == key) return *link;
      if (i == most_links) return overflow_.try_emplace(key, next).first->second;
      link = &following_[*link];
    }
    *link = next;
    keys_.resize(size_t(next) + 1);
    following_.resize(size_t(next) + 1, none);
    keys_[next] = key;
    return next;
  }

 private:
  static constexpr int most_links = 16;
  struct Hash {
    size_t operator()(const CornerKey& key) const {
      return size_t(hash_mix((uint64_t(key.position) << 32) | key.uv, key.normal));
    }
  };

  std::vector<uint32_t> first_;      ///< of each position
  std::vector<CornerKey> keys_;      ///< of each vertex
  std::vector<uint32_t> following_;  ///< vertex of the same position
  std::unordered_map<CornerKey, uint32_t, Hash> overflow_;
};

class ObjReader {
 public:
  ObjReader(const std::string& path, const ObjSelection& selection)
      : path_(path), selection_(selection), lines_(path), cutter_(size_t(lines_.file_size())) {}

  MeshFile read() {
    for (std::string_view line; lines_.next(line);) {
      line_ = lines_.number();
      read_line(line);
    }
    line_ = 0;
    if (mesh_.triangles.empty()) check_selection();
    if (mesh_.triangles.empty()) {
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

  void read_line(std::string_view line);
  void remark_unknown(const std::string& keyword);
  static size_t count_words(std::string_view line);
  void set_colour(size_t position, const Vec3f& encoded);
  /// Of what there are `before` so far; returns what follows them.
  std::string_view read_numbers(std::string_view line, const char* what, size_t before,
                                float* values, int count) const;
  void read_face(std::string_view line);
  CornerKey read_corner(std::string_view word) const;
  uint32_t read_index(std::string_view text, size_t count, std::string_view what) const;
  uint32_t vertex_of(const CornerKey& key);
  void begin_part();
  bool is_selected() const;
  void check_selection() const;
  void add_colour(size_t position);
  void finish_colours();
  void finish();

  std::string path_;
  ObjSelection selection_;
  TextLines lines_;
  int line_ = 1;
  size_t faces_ = 0;
  uint64_t part_ = 0;       ///< of those between groups and materials that have faces
  bool has_faces_ = false;  ///< the part
  std::string material_;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec3f> colours_;  ///< of the positions, as far as there are any
  std::vector<Vec2f> uvs_;
  VertexTable vertices_;
  MeshAttribute vertex_colours_{"vertex_color", 3};
  TriangleMesh mesh_;
  PolygonCutter cutter_;
  std::vector<uint32_t> corners_;  ///< of the face that is read
  size_t small_faces_ = 0;
  std::set<std::string> unknown_;
  std::vector<std::string> remarks_;
  bool any_uv_ = false, any_normal_ = false;
};

/// What says nothing about the faces, or about points and lines alone.
bool is_skipped(std::string_view keyword) {
  constexpr std::string_view known[] = {"o",      "s",   "mg",    "mtllib",     "usemap",
                                        "maplib", "lod", "bevel", "c_interp",   "d_interp",
                                        "l",      "p",   "vp",    "shadow_obj", "trace_obj"};
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
    // After the position may stand a weight, or a colour.
    const std::string_view rest = read_numbers(line, "vertex", positions_.size(), values, 3);
    if (count_words(rest) >= 3) {
      read_numbers(rest, "vertex", positions_.size(), values + 3, 3);
      set_colour(positions_.size(), {values[3], values[4], values[5]});
    }
    positions_.emplace_back(values[0], values[1], values[2]);
  } else if (keyword == "vn") {
    read_numbers(line, "normal", normals_.size(), values, 3);
    normals_.emplace_back(values[0], values[1], values[2]);
  } else if (keyword == "vt") {
    // v may be missing in textures of one dimension.
    std::string_view rest = line;
    next_word(rest);
    const bool has_v = !next_word(rest).empty();
    read_numbers(line, "texture coordinate", uvs_.size(), values, has_v ? 2 : 1);
    uvs_.emplace_back(values[0], values[1]);
  } else if (keyword == "f") {
    read_face(line);
  } else if (keyword == "g") {
    begin_part();
  } else if (keyword == "usemtl") {
    begin_part();
    material_ = trimmed(line);
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

std::string_view ObjReader::read_numbers(std::string_view line, const char* what, size_t before,
                                         float* values, int count) const {
  for (int i = 0; i < count; ++i) {
    std::string_view word = next_word(line);
    const std::string_view given = quotable(word);
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || end != word.data() + word.size())
      fail(fmt::format("{} {}: '{}' is no number", what, before + 1, given),
           "it takes numbers between blanks");
    values[i] = float(value);
    if (error != std::errc() || !std::isfinite(values[i]))
      fail(fmt::format("{} {} is not finite ('{}')", what, before + 1, given),
           "repair the mesh: all coordinates must be numbers");
  }
  return line;
}

/// Mitsuba 0.6 makes a shape of the faces up to the next group or material.
void ObjReader::begin_part() {
  part_ += has_faces_ ? 1 : 0;
  has_faces_ = false;
}

bool ObjReader::is_selected() const {
  if (selection_.shape_index && *selection_.shape_index != part_) return false;
  return !selection_.material || *selection_.material == material_;
}

/// Tells what was selected and is not there.
void ObjReader::check_selection() const {
  const uint64_t parts = part_ + (has_faces_ ? 1 : 0);
  if (selection_.shape_index && parts > 0 && *selection_.shape_index >= parts)
    fail(fmt::format("there is no shape {}", *selection_.shape_index),
         parts == 1 ? "the file holds one, with index 0"
                    : fmt::format("the file holds {}, counted from 0", parts));
  if (selection_.material && faces_ > 0)
    fail(fmt::format("no face has the material '{}'", *selection_.material),
         "name one that a line 'usemtl' of the file names");
}

void ObjReader::read_face(std::string_view line) {
  ++faces_;
  has_faces_ = true;
  if (!is_selected()) return;
  corners_.clear();
  for (std::string_view word = next_word(line); !word.empty() && word[0] != '#';
       word = next_word(line))
    corners_.push_back(vertex_of(read_corner(word)));
  if (corners_.size() < 3)
    ++small_faces_;
  else if (!cutter_.cut(mesh_.positions, corners_, corners_, mesh_.triangles))
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
  const auto next = uint32_t(mesh_.positions.size());
  const uint32_t vertex = vertices_.vertex_of(key, next);
  if (vertex != next) return vertex;
  if (next >= none - 1) fail("the mesh has too many vertices", "split the mesh");
  mesh_.positions.push_back(positions_[key.position]);
  mesh_.uvs.push_back(key.uv != none ? uvs_[key.uv] : Vec2f(0, 0));
  mesh_.normals.push_back(key.normal != none ? normals_[key.normal] : Vec3f(0, 0, 0));
  if (!colours_.empty()) add_colour(key.position);
  any_uv_ |= key.uv != none;
  any_normal_ |= key.normal != none;
  return vertex;
}

/// Of the vertex that was made last. Those before there were colours are white.
void ObjReader::add_colour(size_t position) {
  std::vector<float>& values = vertex_colours_.values;
  values.resize(3 * (mesh_.positions.size() - 1), 1);
  const Vec3f colour = position < colours_.size() ? colours_[position] : Vec3f(1);
  values.insert(values.end(), {colour.x, colour.y, colour.z});
}

void ObjReader::finish_colours() {
  if (colours_.empty()) return;
  colours_ = std::vector<Vec3f>();
  vertex_colours_.values.resize(3 * mesh_.positions.size(), 1);
  vertex_colours_.values.shrink_to_fit();
  if (const size_t count = make_finite(vertex_colours_); count > 0)
    remarks_.push_back(remark_on_attribute(vertex_colours_.name, count, path_));
  mesh_.attributes.push_back(std::move(vertex_colours_));
}

void ObjReader::finish() {
  // What the lines held is not needed any more, and vectors that have grown have room to spare.
  positions_ = std::vector<Vec3f>();
  normals_ = std::vector<Vec3f>();
  uvs_ = std::vector<Vec2f>();
  vertices_ = VertexTable();
  if (!any_uv_) mesh_.uvs.clear();
  if (!any_normal_) mesh_.normals.clear();
  finish_colours();
  mesh_.uvs.shrink_to_fit();
  mesh_.normals.shrink_to_fit();
  mesh_.triangles.shrink_to_fit();
  std::vector<Vec3f> positions;
  positions.reserve(mesh_.positions.size() + 1);  // see MeshShape
  positions.insert(positions.end(), mesh_.positions.begin(), mesh_.positions.end());
  mesh_.positions = std::move(positions);
  if (small_faces_ > 0) remarks_.push_back(remark_on_small_faces(small_faces_, path_));
}

}  // namespace

MeshFile read_obj(const std::string& path, const ObjSelection& selection) {
  return ObjReader(path, selection).read();
}

}  // namespace kaustik
