#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// What an OBJ file holds, as far as a reader of scenes must know.
struct ObjScan {
  Bounds3f bounds;  ///< of its vertices; empty where it has none
  bool has_normals = false, has_faces = false;
  uint64_t bytes = 0;                    ///< of the file
  std::optional<Place> first_line = {};  ///< of lines and points; none: it has neither
  /// Those that faces have, "" for none, with the first line that names them; in their order.
  std::vector<std::pair<std::string, Place>> materials = {};
  /// What follows `mtllib`, at most 100 of them.
  std::vector<std::pair<std::string, Place>> libraries = {};
};

/// Goes through the lines of a file; those that are wrong do not count. Throws Error(input) if it
/// cannot be read.
ObjScan scan_obj(const std::string& path);

}  // namespace kaustik
