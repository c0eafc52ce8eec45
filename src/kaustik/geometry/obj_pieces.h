#pragma once
// An OBJ file in pieces that threads read side by side; for its reader alone.

#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/text_lines.h"

namespace kaustik {

/// What a line of an OBJ file is, by its first word.
enum class ObjLine { position, uv, normal, face, group, material, skipped, unknown };

/// How many lines there are of some kinds.
struct ObjCounts {
  uint64_t lines = 0, positions = 0, uvs = 0, normals = 0, faces = 0;

  /// One line of that kind; of the others, and of all, nothing.
  void add(ObjLine kind);
  uint64_t of(ObjLine kind) const;
};

/// The parts between groups and materials, counted as lines go by: those with faces, as Mitsuba 0.6
/// makes shapes of them.
struct ObjParts {
  uint64_t index = 0;      ///< of the part that a face would be of
  bool has_faces = false;  ///< that part
  std::string material;    ///< "": none yet

  /// `rest`: of the line, behind its first word.
  void add(ObjLine kind, std::string_view rest);
  uint64_t size() const { return index + (has_faces ? 1 : 0); }
};

/// Lines that begin between two bytes of the file.
struct ObjPiece {
  uint64_t begin = 0, end = 0;
  ObjCounts before = {}, own = {};  ///< of the pieces before, and of this one
  ObjParts parts_before = {};       ///< where it begins
  uint64_t text_bytes = 0;          ///< of its lines
};

/// The lines of a piece, one after the other.
class ObjLines {
 public:
  ObjLines(const InputFile& file, const ObjPiece& piece)
      : lines_(file, piece.begin, piece.end),
        first_line_(piece.before.lines),
        before_(piece.before) {}

  /// False: there is none left.
  bool next();
  ObjLine kind() const { return kind_; }
  /// The line's first word in small letters; of lines of no known kind alone.
  const std::string& keyword() const { return keyword_; }
  /// What follows the first word.
  std::string_view rest() const { return rest_; }
  /// In the file, from 1.
  uint64_t number() const { return first_line_ + uint64_t(lines_.number()); }
  /// What the file has before the line.
  const ObjCounts& before() const { return before_; }
  uint64_t position() const { return lines_.position(); }

 private:
  TextLines lines_;
  uint64_t first_line_;
  ObjCounts before_;
  ObjLine kind_ = ObjLine::skipped;
  std::string keyword_;
  std::string_view rest_;
};

/// A line whose first word is unknown.
struct UnknownObjLine {
  std::string keyword;
  uint64_t line = 0;
};

/// All of a file, by its lines' first words.
struct ObjSurvey {
  std::vector<ObjPiece> pieces;
  ObjCounts all;
  ObjParts parts;  ///< at the end
  /// The first lines with different unknown words, at most `most_unknown`.
  std::vector<UnknownObjLine> unknown;

  static constexpr size_t most_unknown = 5;
};

/// Throws Error(input) for text in UTF-16.
ObjSurvey survey_obj(const InputFile& file);

}  // namespace kaustik
