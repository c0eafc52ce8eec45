#pragma once
// What a PLY file says that it holds; for the reader alone.

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/geometry/file_window.h"
#include "kaustik/geometry/ply_values.h"

namespace kaustik {

enum class PlyFormat { text, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< of lists
  PlyType type = PlyType::float32;
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

struct PlyHeader {
  PlyFormat format = PlyFormat::text;
  std::vector<PlyElement> elements;
  char line_end = '\n';  ///< '\r' where no '\n' follows
  int lines = 0;         ///< that it takes
};

/// Reads the header; the window then stands behind it. Throws Error(input), which names the line,
/// for what is no header.
PlyHeader read_ply_header(const std::string& path, FileWindow& window);

/// Throws the error about a PLY file; `line` 0: none.
[[noreturn]] void fail_in_ply(const std::string& path, int line, const std::string& what,
                              const std::string& remedy);

}  // namespace kaustik
