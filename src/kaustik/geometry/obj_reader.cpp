// Wavefront OBJ, read here rather than by a library for its messages: line numbers, and numbers
// that are none must not become zero.
//
// The file is gone through several times, in pieces and in parallel: for what there is, then for
// positions, faces, normals and texture coordinates in turn. So all numbers of the file are never
// in memory beside all of the mesh.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "kaustik/base/decimal.h"
#include "kaustik/base/parallel.h"
#include "kaustik/base/polygon_cutter.h"
#include "kaustik/base/srgb.h"
#include "kaustik/geometry/mesh_attribute.h"
#include "kaustik/geometry/mesh_checks.h"
#include "kaustik/geometry/mesh_reader.h"
#include "kaustik/geometry/obj_pieces.h"
#include "kaustik/geometry/obj_vertices.h"

namespace kaustik {
namespace {

/// Pieces of faces that are read before their vertices get numbers.
constexpr size_t pieces_at_once = 32;
constexpr size_t gathered_at_once = size_t{1} << 16;

/// What is wrong with a line.
struct LineFault {
  uint64_t line;
  std::string what, remedy;
};

/// For a message. A scene may name any file: words are shown once there is a vertex before.
std::string_view quotable(const ObjLines& line, std::string_view word) {
  return line.before().positions == 0 ? "…" : word.substr(0, 40);
}

// Numbers -----------------------------------------------------------------------------------------

/// Takes numbers off what is left of a line; `what` they are, of which there are `before` so far.
void take_numbers(const ObjLines& line, std::string_view& rest, const char* what, uint64_t before,
                  float* values, int count) {
  for (int i = 0; i < count; ++i) {
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    std::string_view quick = rest;
    double value = 0;
    if (take_decimal(quick, value) && (quick.empty() || is_blank(quick.front()))) [[likely]] {
      values[i] = float(value);
      rest = quick;
      continue;
    }
    std::string_view word = next_word(rest);
    const std::string_view given = quotable(line, word);
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || end != word.data() + word.size())
      throw LineFault{line.number(),
                      fmt::format("{} {}: '{}' is no number", what, before + 1, given),
                      "it takes numbers between blanks"};
    values[i] = float(value);
    if (error != std::errc() || !std::isfinite(values[i]))
      throw LineFault{line.number(),
                      fmt::format("{} {} is not finite ('{}')", what, before + 1, given),
                      "repair the mesh: all coordinates must be numbers"};
  }
}

size_t count_words(std::string_view text) {
  size_t count = 0;
  for (std::string_view word = next_word(text); !word.empty() && word[0] != '#';
       word = next_word(text))
    ++count;
  return count;
}

/// After the position may stand a weight, or a colour; whether a colour does.
bool read_position(const ObjLines& line, Vec3f& position, Vec3f& colour) {
  std::string_view rest = line.rest();
  float values[3];
  take_numbers(line, rest, "vertex", line.before().positions, values, 3);
  position = {values[0], values[1], values[2]};
  if (rest.empty() || count_words(rest) < 3) return false;
  take_numbers(line, rest, "vertex", line.before().positions, values, 3);
  // Encoded, as MeshLab and Blender write them.
  colour = {linear_from_srgb(values[0]), linear_from_srgb(values[1]), linear_from_srgb(values[2])};
  return true;
}

void read_vector(const ObjLines& line, Vec3f& normal) {
  std::string_view rest = line.rest();
  float values[3];
  take_numbers(line, rest, "normal", line.before().normals, values, 3);
  normal = {values[0], values[1], values[2]};
}

/// v may be missing in textures of one dimension.
void read_vector(const ObjLines& line, Vec2f& uv) {
  std::string_view rest = line.rest();
  float u = 0, v = 0;
  take_numbers(line, rest, "texture coordinate", line.before().uvs, &u, 1);
  if (!trimmed(rest).empty())
    take_numbers(line, rest, "texture coordinate", line.before().uvs, &v, 1);
  uv = {u, v};
}

// Corners -----------------------------------------------------------------------------------------

/// 0 where there are no digits, or more than an index mostly has.
uint32_t take_index(const char*& at, const char* end) {
  uint32_t value = 0;
  return take_digits(at, end, value) < 8 ? value : 0;
}

/// Takes a corner off that is written with digits and slashes alone. False, and nothing taken:
/// another stands there.
bool take_plain_corner(std::string_view& text, const ObjCounts& before, ObjCorner& corner) {
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto is_next = [&](char c) { return at != end && *at == c; };
  const uint32_t position = take_index(at, end);
  uint32_t uv = 0, normal = 0;
  if (is_next('/')) {
    ++at;
    if (!is_next('/') && (uv = take_index(at, end)) == 0) return false;
    if (is_next('/') && (normal = take_index(++at, end)) == 0) return false;
  }
  if (position == 0 || (at != end && !is_blank(*at))) return false;
  if (position > before.positions || uv > before.uvs || normal > before.normals) return false;
  corner = {position - 1, uv - 1, normal - 1};  // 0 becomes `none`
  static_assert(ObjCorner::none == uint32_t{0} - 1);
  text.remove_prefix(size_t(at - text.data()));
  return true;
}

/// Counts from 1; negative: back from the last one so far.
uint32_t read_index(const ObjLines& line, std::string_view text, uint64_t count, const char* what) {
  int64_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  const uint64_t face = line.before().faces + 1;
  if (error != std::errc() || end != text.data() + text.size())
    throw LineFault{line.number(),
                    fmt::format("face {}: '{}' is no index", face, quotable(line, text)),
                    "corners are written 1, 1/2, 1//3 or 1/2/3"};
  const int64_t from_zero = index > 0 ? index - 1 : int64_t(count) + index;
  if (index == 0 || from_zero < 0 || from_zero >= int64_t(count))
    throw LineFault{line.number(),
                    fmt::format("face {} refers to {} {} of {}", face, what, index, count),
                    "indices count from 1, or back from -1, over what comes before the face"};
  return uint32_t(from_zero);
}

ObjCorner read_corner(const ObjLines& line, std::string_view word) {
  // "position", "position/uv", "position//normal" or "position/uv/normal"
  ObjCorner corner;
  const ObjCounts& before = line.before();
  const size_t slash = word.find('/');
  corner.position = read_index(line, word.substr(0, slash), before.positions, "vertex");
  if (slash == word.npos) return corner;
  const std::string_view rest = word.substr(slash + 1);
  const size_t second = rest.find('/');
  const std::string_view uv = rest.substr(0, second);
  if (!uv.empty()) corner.uv = read_index(line, uv, before.uvs, "texture coordinate");
  if (second != rest.npos && second + 1 < rest.size())
    corner.normal = read_index(line, rest.substr(second + 1), before.normals, "normal");
  return corner;
}

/// Faces that take too long to be cut into triangles, which are left out.
struct UncutFaces {
  size_t count = 0;
  uint64_t first_line = 0;
};

/// The faces of a piece, whose corners have numbers of the piece's own.
class PieceOfFaces {
 public:
  /// As it was before it read anything.
  void clear();
  /// Reads those that are `selected(parts)`, up to a line. `positions`: all of the file.
  template <typename Selected>
  void read(const InputFile& file, const ObjPiece& piece, uint64_t line_limit,
            std::span<const Vec3f> positions, const Selected& selected);
  /// Gives the corners their numbers in the mesh, in the order in which faces use them.
  void number(ObjVertices& vertices);
  /// Writes the triangles, with vertices of the mesh.
  void write(std::array<uint32_t, 3>* to) const;

  size_t triangle_count() const { return triangles_.size(); }
  size_t small_faces() const { return small_faces_; }
  const UncutFaces& uncut_faces() const { return uncut_; }

 private:
  void read_face(const ObjLines& line, std::span<const Vec3f> positions, PolygonCutter& cutter);
  void cut_face(const ObjLines& line, std::span<const Vec3f> positions, PolygonCutter& cutter);

  std::vector<ObjCorner> corners_;  ///< all different
  ObjCornerTable table_;
  PolygonCutter::Triangles triangles_;
  std::vector<uint32_t> vertices_;            ///< of the corners
  std::vector<uint32_t> places_, positions_;  ///< of the face: corners, and what they use
  size_t small_faces_ = 0;
  UncutFaces uncut_;
};

void PieceOfFaces::clear() {
  corners_.clear();
  table_.clear();
  triangles_.clear();
  small_faces_ = 0;
  uncut_ = {};
}

template <typename Selected>
void PieceOfFaces::read(const InputFile& file, const ObjPiece& piece, uint64_t line_limit,
                        std::span<const Vec3f> positions, const Selected& selected) {
  ObjParts parts = piece.parts_before;
  PolygonCutter cutter(piece.text_bytes);
  for (ObjLines line(file, piece); line.next() && line.number() < line_limit;) {
    parts.add(line.kind(), line.rest());
    if (line.kind() == ObjLine::face && selected(parts)) read_face(line, positions, cutter);
  }
}

void PieceOfFaces::read_face(const ObjLines& line, std::span<const Vec3f> positions,
                             PolygonCutter& cutter) {
  places_.clear();
  positions_.clear();
  for (std::string_view rest = line.rest();;) {
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    if (rest.empty() || rest.front() == '#') break;
    ObjCorner corner;
    if (!take_plain_corner(rest, line.before(), corner)) [[unlikely]]
      corner = read_corner(line, next_word(rest));
    const auto next = uint32_t(corners_.size());
    const uint32_t place =
        table_.number_of(corner, next, [&](uint32_t known) { return corners_[known]; });
    if (place == next) corners_.push_back(corner);
    places_.push_back(place);
    positions_.push_back(corner.position);
  }
  if (places_.size() < 3)
    ++small_faces_;
  else if (places_.size() == 3)
    triangles_.push_back({places_[0], places_[1], places_[2]});
  else
    cut_face(line, positions, cutter);
}

void PieceOfFaces::cut_face(const ObjLines& line, std::span<const Vec3f> positions,
                            PolygonCutter& cutter) {
  const size_t before = triangles_.size();
  if (cutter.cut(positions.first(line.before().positions), positions_, places_, triangles_)) return;
  triangles_.resize(before);
  if (uncut_.count++ == 0) uncut_.first_line = line.number();
}

void PieceOfFaces::number(ObjVertices& vertices) {
  vertices_.clear();
  for (const ObjCorner& corner : corners_) vertices_.push_back(vertices.vertex_of(corner));
}

void PieceOfFaces::write(std::array<uint32_t, 3>* to) const {
  for (const auto& [a, b, c] : triangles_) *to++ = {vertices_[a], vertices_[b], vertices_[c]};
}

// The file ----------------------------------------------------------------------------------------

/// What vertices use of `from`, by its numbers; `missing` where they use none.
template <typename Vector>
void gather(const UnsetVector<Vector>& from, const UnsetVector<uint32_t>& numbers,
            const Vector& missing, Vector* to) {
  parallel_blocks(numbers.size(), gathered_at_once, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      const Vector& vector = numbers[i] == ObjCorner::none ? missing : from[numbers[i]];
      std::memcpy(static_cast<void*>(&to[i]), &vector, sizeof(Vector));
    }
  });
}

class ObjReader {
 public:
  ObjReader(const std::string& path, const ObjSelection& selection)
      : path_(path), selection_(selection), file_(path), survey_(survey_obj(file_)) {}

  MeshFile read() {
    check_counts();
    read_positions();
    read_faces();
    finish_positions();
    mesh_.normals = read_vectors<Vec3f>(ObjLine::normal, vertices_->normals());
    mesh_.uvs = read_vectors<Vec2f>(ObjLine::uv, vertices_->uvs());
    if (fault_) fail(fault_->what, fault_->remedy, fault_->line);
    if (mesh_.triangles.empty()) {
      check_selection();
      const MeshFault fault = fault_of_no_faces();
      fail(fault.message, fault.remedy);
    }
    return {std::move(mesh_), remarks()};
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy,
                         uint64_t line = 0) const {
    throw Error(ErrorKind::input, "OBJ: " + what, remedy, place_in(path_, int(line)));
  }

  void check_counts() const;
  void read_positions();
  void read_faces();
  void finish_positions();
  template <typename Vector>
  std::vector<Vector> read_vectors(ObjLine kind, UnsetVector<uint32_t>& numbers);

  /// Lines from there on are not looked at: one before is faulty.
  uint64_t line_limit() const { return fault_ ? fault_->line : ~uint64_t{0}; }
  /// Calls body(i, piece) for some pieces, in parallel; keeps what is wrong with the first line
  /// of which anything is.
  template <typename Body>
  void each_piece(std::span<const ObjPiece* const> pieces, const Body& body);
  std::vector<const ObjPiece*> pieces_with(ObjLine kind) const;
  /// Reads all lines of a kind: read_one(line, number) the one of that number.
  template <typename ReadOne>
  void read_lines(ObjLine kind, const ReadOne& read_one);

  bool is_selected(const ObjParts& parts) const {
    if (selection_.shape_index && *selection_.shape_index != parts.index) return false;
    return !selection_.material || *selection_.material == parts.material;
  }
  void check_selection() const;
  std::vector<std::string> remarks() const;

  std::string path_;
  ObjSelection selection_;
  InputFile file_;
  ObjSurvey survey_;
  std::optional<LineFault> fault_;  ///< the first one so far
  UnsetVector<Vec3f> positions_, colours_;
  bool has_colours_ = false;
  std::optional<ObjVertices> vertices_;
  TriangleMesh mesh_;
  size_t small_faces_ = 0, infinite_colours_ = 0;
  UncutFaces uncut_;
};

void ObjReader::check_counts() const {
  for (const auto& [count, name] : {std::pair(survey_.all.positions, "v"),
                                    {survey_.all.uvs, "vt"},
                                    {survey_.all.normals, "vn"}})
    if (const auto fault = fault_of_count(count, name)) fail(fault->message, fault->remedy);
}

template <typename Body>
void ObjReader::each_piece(std::span<const ObjPiece* const> pieces, const Body& body) {
  std::vector<std::optional<LineFault>> faults(pieces.size());
  parallel_blocks(pieces.size(), 1, [&](size_t i, size_t, size_t) {
    if (pieces[i]->before.lines >= line_limit()) return;
    try {
      body(i, *pieces[i]);
    } catch (const LineFault& fault) {
      faults[i] = fault;
    }
  });
  for (const auto& fault : faults)
    if (fault && fault->line < line_limit()) fault_ = fault;
}

std::vector<const ObjPiece*> ObjReader::pieces_with(ObjLine kind) const {
  std::vector<const ObjPiece*> pieces;
  for (const ObjPiece& piece : survey_.pieces)
    if (piece.own.of(kind) > 0) pieces.push_back(&piece);
  return pieces;
}

template <typename ReadOne>
void ObjReader::read_lines(ObjLine kind, const ReadOne& read_one) {
  each_piece(pieces_with(kind), [&](size_t, const ObjPiece& piece) {
    for (ObjLines line(file_, piece); line.next() && line.number() < line_limit();)
      if (line.kind() == kind) read_one(line, size_t(line.before().of(kind)));
  });
}

void ObjReader::read_positions() {
  const auto count = size_t(survey_.all.positions);
  reserve_large(positions_, count);
  positions_.resize(count);
  // Memory that nothing is written to is none.
  reserve_large(colours_, count);
  colours_.resize(count);
  const std::vector<const ObjPiece*> pieces = pieces_with(ObjLine::position);
  const auto colours_of = [&](const ObjPiece& piece) {
    return std::span(colours_).subspan(size_t(piece.before.positions), size_t(piece.own.positions));
  };
  std::vector<char> has_colours(pieces.size(), 0);
  each_piece(pieces, [&](size_t i, const ObjPiece& piece) {
    for (ObjLines line(file_, piece); line.next() && line.number() < line_limit();) {
      if (line.kind() != ObjLine::position) continue;
      const auto number = size_t(line.before().positions);
      Vec3f colour;
      if (!read_position(line, positions_[number], colour)) continue;
      if (!has_colours[i]) std::ranges::fill(colours_of(piece), Vec3f(1));
      has_colours[i] = 1;
      colours_[number] = colour;
    }
  });
  has_colours_ = std::find(has_colours.begin(), has_colours.end(), 1) != has_colours.end();
  // Those without are white.
  for (size_t i = 0; has_colours_ && i < pieces.size(); ++i)
    if (!has_colours[i]) std::ranges::fill(colours_of(*pieces[i]), Vec3f(1));
}

void ObjReader::read_faces() {
  vertices_.emplace(size_t(survey_.all.positions));
  vertices_->reserve(
      size_t(std::max({survey_.all.positions, survey_.all.uvs, survey_.all.normals})));
  reserve_large(mesh_.triangles, size_t(survey_.all.faces));
  const std::vector<const ObjPiece*> with_faces = pieces_with(ObjLine::face);
  std::vector<PieceOfFaces> read(std::min(pieces_at_once, with_faces.size()));
  for (size_t first = 0; first < with_faces.size(); first += pieces_at_once) {
    const auto some =
        std::span(with_faces).subspan(first, std::min(pieces_at_once, with_faces.size() - first));
    for (PieceOfFaces& piece : read) piece.clear();
    each_piece(some, [&](size_t i, const ObjPiece& piece) {
      read[i].read(file_, piece, line_limit(), positions_,
                   [&](const ObjParts& parts) { return is_selected(parts); });
    });
    if (fault_) continue;
    std::vector<size_t> begins;
    size_t count = mesh_.triangles.size();
    for (size_t i = 0; i < some.size(); ++i) {
      read[i].number(*vertices_);
      begins.push_back(count);
      count += read[i].triangle_count();
      small_faces_ += read[i].small_faces();
      if (uncut_.count == 0) uncut_.first_line = read[i].uncut_faces().first_line;
      uncut_.count += read[i].uncut_faces().count;
    }
    if (const auto fault = fault_of_count(vertices_->size(), "vertex"))
      fail(fault->message, fault->remedy);
    mesh_.triangles.resize(count);
    parallel_blocks(some.size(), 1, [&](size_t i, size_t, size_t) {
      read[i].write(mesh_.triangles.data() + begins[i]);
    });
  }
}

void ObjReader::finish_positions() {
  vertices_->finish();
  UnsetVector<uint32_t>& numbers = vertices_->positions();
  if (!fault_) {
    reserve_large(mesh_.positions, numbers.size() + 1);  // see MeshShape
    mesh_.positions.resize(numbers.size());
    gather(positions_, numbers, Vec3f(0), mesh_.positions.data());
    if (has_colours_) {
      MeshAttribute attribute{"vertex_color", 3};
      attribute.values.resize(3 * numbers.size());
      gather(colours_, numbers, Vec3f(1), reinterpret_cast<Vec3f*>(attribute.values.data()));
      infinite_colours_ = make_finite(attribute);
      mesh_.attributes.push_back(std::move(attribute));
    }
  }
  positions_ = UnsetVector<Vec3f>();
  colours_ = UnsetVector<Vec3f>();
  numbers = UnsetVector<uint32_t>();
}

/// Reads the vectors of a kind, for the vertices that use those with such numbers; none where no
/// vertex uses any.
template <typename Vector>
std::vector<Vector> ObjReader::read_vectors(ObjLine kind, UnsetVector<uint32_t>& numbers) {
  const auto count = size_t(survey_.all.of(kind));
  UnsetVector<Vector> from;
  reserve_large(from, count);
  from.resize(count);
  read_lines(kind, [&](const ObjLines& line, size_t number) { read_vector(line, from[number]); });
  std::vector<Vector> vectors;
  const auto is_used = [](uint32_t number) { return number != ObjCorner::none; };
  if (!fault_ && std::any_of(numbers.begin(), numbers.end(), is_used)) {
    reserve_large(vectors, numbers.size());
    vectors.resize(numbers.size());
    gather(from, numbers, Vector(0), vectors.data());
  }
  numbers = UnsetVector<uint32_t>();
  return vectors;
}

/// Tells what was selected and is not there.
void ObjReader::check_selection() const {
  const uint64_t parts = survey_.parts.size();
  if (selection_.shape_index && parts > 0 && *selection_.shape_index >= parts)
    fail(fmt::format("there is no shape {}", *selection_.shape_index),
         parts == 1 ? "the file holds one, with index 0"
                    : fmt::format("the file holds {}, counted from 0", parts));
  if (selection_.material && survey_.all.faces > 0)
    fail(fmt::format("no face has the material '{}'", *selection_.material),
         "name one that a line 'usemtl' of the file names");
}

/// What was left out, or is not as it should be.
std::vector<std::string> ObjReader::remarks() const {
  std::vector<std::string> remarks;
  for (const UnknownObjLine& unknown : survey_.unknown)
    remarks.push_back(fmt::format(
        "{}:{}: lines that begin with '{}' are skipped: OBJ files of faces have none{}", path_,
        unknown.line, unknown.keyword,
        remarks.size() + 1 == ObjSurvey::most_unknown ? "; there may be more such lines" : ""));
  if (infinite_colours_ > 0)
    remarks.push_back(remark_on_attribute("vertex_color", infinite_colours_, path_));
  if (small_faces_ > 0) remarks.push_back(remark_on_small_faces(small_faces_, path_));
  if (uncut_.count > 0)
    remarks.push_back(
        fmt::format("{}:{}: {} left out: to cut so many corners into triangles takes too long",
                    path_, uncut_.first_line,
                    uncut_.count == 1 ? "a face was" : fmt::format("{} faces were", uncut_.count)));
  return remarks;
}

}  // namespace

MeshFile read_obj(const std::string& path, const ObjSelection& selection) {
  return ObjReader(path, selection).read();
}

}  // namespace kaustik
