// Wavefront OBJ, read here rather than by a library for its messages: line numbers, and numbers
// that are none must not become zero.

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <unordered_map>

#include "kaustik/base/file.h"
#include "kaustik/base/sampler.h"
#include "kaustik/geometry/mesh_reader.h"

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
  explicit ObjReader(const std::string& path) : path_(path), bytes_(read_file(path)) {}

  TriangleMesh read() {
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    for (size_t begin = 0; begin < text.size();) {
      const size_t end = std::min(text.find('\n', begin), text.size());
      ++line_;
      read_line(text.substr(begin, end - begin));
      begin = end + 1;
    }
    if (mesh_.triangles.empty()) {
      line_ = 0;
      fail("the mesh has no faces", "export the object as a mesh with faces");
    }
    finish();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorKind::input, "OBJ: " + what, remedy, place_in(path_, line_));
  }

  void read_line(std::string_view line);
  void read_numbers(std::string_view line, std::string_view what, float* values, int count) const;
  void read_face(std::string_view line);
  CornerKey read_corner(std::string_view word) const;
  uint32_t read_index(std::string_view text, size_t count, std::string_view what) const;
  uint32_t vertex_of(const CornerKey& key);
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
  int line_ = 0;
  size_t faces_ = 0;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec2f> uvs_;
  std::unordered_map<CornerKey, uint32_t, CornerHash> vertices_;
  TriangleMesh mesh_;
  bool any_uv_ = false, any_normal_ = false;
};

void ObjReader::read_line(std::string_view line) {
  const std::string_view keyword = next_word(line);
  float values[3] = {0, 0, 0};
  if (keyword == "v") {
    read_numbers(line, fmt::format("vertex {}", positions_.size() + 1), values, 3);
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
  }
}

void ObjReader::read_numbers(std::string_view line, std::string_view what, float* values,
                             int count) const {
  for (int i = 0; i < count; ++i) {
    std::string_view word = next_word(line);
    const std::string_view given = word.substr(0, 40);
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
}

void ObjReader::read_face(std::string_view line) {
  ++faces_;
  uint32_t first = 0, previous = 0;
  size_t corners = 0;
  for (std::string_view word = next_word(line); !word.empty() && word[0] != '#';
       word = next_word(line), ++corners) {
    const uint32_t vertex = vertex_of(read_corner(word));
    if (corners == 0) first = vertex;
    if (corners >= 2) mesh_.triangles.push_back({first, previous, vertex});
    previous = vertex;
  }
  if (corners < 3)
    fail(fmt::format("face {} has {} corners", faces_, corners), "a face needs at least three");
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
    fail(fmt::format("face {}: '{}' is no index", faces_, text.substr(0, 40)),
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

void ObjReader::finish() {
  if (!any_uv_) mesh_.uvs.clear();
  if (!any_normal_) mesh_.normals.clear();
}

}  // namespace

TriangleMesh read_obj(const std::string& path) { return ObjReader(path).read(); }

}  // namespace kaustik
