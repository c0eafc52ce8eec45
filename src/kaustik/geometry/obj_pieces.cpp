#include "kaustik/geometry/obj_pieces.h"

#include <algorithm>

#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

/// They stay in a core's cache, with what they become.
constexpr uint64_t piece_size = uint64_t{1} << 18;

/// What says nothing about the faces, or about points and lines alone.
bool is_skipped(std::string_view keyword) {
  constexpr std::string_view known[] = {"o",      "s",   "mg",    "mtllib",     "usemap",
                                        "maplib", "lod", "bevel", "c_interp",   "d_interp",
                                        "l",      "p",   "vp",    "shadow_obj", "trace_obj"};
  return keyword.empty() || keyword[0] == '#' ||
         std::find(std::begin(known), std::end(known), keyword) != std::end(known);
}

/// Of a line that begins with one or two letters and a blank, which most do.
ObjLine quick_kind(std::string_view line) {
  const auto letter = [&](size_t i) { return i < line.size() ? char(line[i] | 0x20) : ' '; };
  const auto ends = [&](size_t i) { return i >= line.size() || is_blank(line[i]); };
  if (letter(0) == 'f' && ends(1)) return ObjLine::face;
  if (letter(0) != 'v') return ObjLine::unknown;
  if (ends(1)) return ObjLine::position;
  if (!ends(2)) return ObjLine::unknown;
  if (letter(1) == 'n') return ObjLine::normal;
  return letter(1) == 't' ? ObjLine::uv : ObjLine::unknown;
}

ObjLine kind_of(std::string_view keyword) {
  if (keyword == "g") return ObjLine::group;
  if (keyword == "usemtl") return ObjLine::material;
  if (is_skipped(keyword)) return ObjLine::skipped;
  return quick_kind(keyword);
}

/// What a piece has, before it is known what comes before it.
struct Found {
  ObjCounts counts;
  uint64_t text_bytes = 0;
  std::vector<UnknownObjLine> unknown;
  bool has_faces_first = false, has_breaks = false;  ///< faces before the first group or material
  ObjParts after;                                    ///< what follows the first of them
  bool names_material = false;

  void add_part(const ObjLines& line);
  void add_unknown(const ObjLines& line);
  /// Moves `parts` from the beginning of the piece to its end.
  void pass(ObjParts& parts) const;
};

void Found::add_part(const ObjLines& line) {
  const bool is_face = line.kind() == ObjLine::face;
  names_material |= line.kind() == ObjLine::material;
  has_faces_first |= is_face && !has_breaks;
  has_breaks |= !is_face;
  if (has_breaks) after.add(line.kind(), line.rest());
}

void Found::pass(ObjParts& parts) const {
  parts.has_faces |= has_faces_first;
  if (!has_breaks) return;
  parts.index = parts.size() + after.index;
  parts.has_faces = after.has_faces;
  if (names_material) parts.material = after.material;
}

void Found::add_unknown(const ObjLines& line) {
  const std::string keyword = line.keyword().substr(0, 40);
  const auto is_same = [&](const UnknownObjLine& other) { return other.keyword == keyword; };
  if (unknown.size() < ObjSurvey::most_unknown &&
      std::none_of(unknown.begin(), unknown.end(), is_same))
    unknown.push_back({keyword, line.number()});
}

Found look_through(const InputFile& file, const ObjPiece& piece) {
  Found found;
  ObjLines line(file, piece);
  const uint64_t begin = line.position();
  while (line.next()) {
    const ObjLine kind = line.kind();
    if (kind == ObjLine::face || kind == ObjLine::group || kind == ObjLine::material)
      found.add_part(line);
    else if (kind == ObjLine::unknown)
      found.add_unknown(line);
  }
  found.counts = line.before();
  found.counts.lines = line.number() - 1;
  found.text_bytes = line.position() - begin;
  return found;
}

}  // namespace

void ObjCounts::add(ObjLine kind) {
  positions += kind == ObjLine::position ? 1 : 0;
  uvs += kind == ObjLine::uv ? 1 : 0;
  normals += kind == ObjLine::normal ? 1 : 0;
  faces += kind == ObjLine::face ? 1 : 0;
}

uint64_t ObjCounts::of(ObjLine kind) const {
  switch (kind) {
    case ObjLine::position:
      return positions;
    case ObjLine::uv:
      return uvs;
    case ObjLine::normal:
      return normals;
    case ObjLine::face:
      return faces;
    default:
      return 0;
  }
}

void ObjParts::add(ObjLine kind, std::string_view rest) {
  if (kind == ObjLine::face) {
    has_faces = true;
  } else if (kind == ObjLine::group || kind == ObjLine::material) {
    index = size();
    has_faces = false;
    if (kind == ObjLine::material) material = trimmed(rest);
  }
}

bool ObjLines::next() {
  before_.add(kind_);
  kind_ = ObjLine::skipped;
  if (!lines_.next(rest_)) return false;
  kind_ = quick_kind(rest_);
  if (kind_ != ObjLine::unknown) {
    rest_.remove_prefix(kind_ == ObjLine::normal || kind_ == ObjLine::uv ? 2 : 1);
    return true;
  }
  keyword_ = next_word(rest_);
  for (char& c : keyword_)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  kind_ = kind_of(keyword_);
  return true;
}

ObjSurvey survey_obj(const InputFile& file) {
  ObjSurvey survey;
  for (uint64_t begin = 0; begin < file.size(); begin += piece_size)
    survey.pieces.push_back({.begin = begin, .end = std::min(begin + piece_size, file.size())});
  std::vector<Found> found(survey.pieces.size());
  parallel_blocks(found.size(), 1, [&](size_t i, size_t, size_t) {
    found[i] = look_through(file, survey.pieces[i]);
  });
  for (size_t i = 0; i < found.size(); ++i) {
    ObjPiece& piece = survey.pieces[i];
    piece.own = found[i].counts;
    piece.text_bytes = found[i].text_bytes;
    piece.before = survey.all;
    piece.parts_before = survey.parts;
    found[i].pass(survey.parts);
    for (UnknownObjLine& unknown : found[i].unknown) {
      const auto is_same = [&](const auto& other) { return other.keyword == unknown.keyword; };
      if (survey.unknown.size() < ObjSurvey::most_unknown &&
          std::none_of(survey.unknown.begin(), survey.unknown.end(), is_same))
        survey.unknown.push_back({unknown.keyword, unknown.line + survey.all.lines});
    }
    const ObjCounts& own = piece.own;
    survey.all = {survey.all.lines + own.lines, survey.all.positions + own.positions,
                  survey.all.uvs + own.uvs, survey.all.normals + own.normals,
                  survey.all.faces + own.faces};
  }
  return survey;
}

}  // namespace kaustik
