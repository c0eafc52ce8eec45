#pragma once
#include <fmt/format.h>

#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"

namespace kaustik::test {

/// The file of a mesh that is the shape `rectangle`, cut across x into `slices` of two triangles
/// each.
class StripMesh {
 public:
  explicit StripMesh(int slices) {
    std::ofstream file(folder_.path("strip.obj"));
    for (int i = 0; i <= slices; ++i) {
      const double x = -1 + 2.0 * i / slices;
      file << fmt::format("v {0} -1 0\nv {0} 1 0\n", x);
    }
    for (int i = 0; i < slices; ++i) {
      const int a = 2 * i + 1;
      file << fmt::format("f {0} {2} {3}\nf {0} {3} {1}\n", a, a + 1, a + 2, a + 3);
    }
  }
  std::string shape(const std::string& transform, const std::string& inside) const {
    return fmt::format(
        R"(<shape type="obj"><string name="filename" value="{}"/>
        <transform name="to_world">{}</transform>{}</shape>)",
        folder_.path("strip.obj"), transform, inside);
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace kaustik::test
