#pragma once
#include <string>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// A place and a direction there, of any length but zero.
struct DirectedPlace {
  Vec3d place, direction;
};

/// A text file with six numbers on each line, as Radiance's rtrace reads them: a place and a
/// direction. Between numbers stand blanks, commas or semicolons. What follows a # does not count,
/// nor do empty lines, nor a first line without digits, as tables have it. Throws Error(input) with
/// file and line for anything else, for a file without a row, and for one with more than `most`.
std::vector<DirectedPlace> read_direction_file(const std::string& path, size_t most);

}  // namespace kaustik
