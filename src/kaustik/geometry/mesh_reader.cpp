#include "kaustik/geometry/mesh_reader.h"

#include <fmt/format.h>

namespace kaustik {

std::string remark_on_small_faces(size_t count, const std::string& file) {
  return fmt::format("{}: {} {} left out: fewer than three corners", file, count,
                     count == 1 ? "face was" : "faces were");
}

}  // namespace kaustik
