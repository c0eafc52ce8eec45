#pragma once
// What the tests of Nori's reader share.

#include "kaustik/loader/nori_scene.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::nori {

using namespace pbrt;

inline const std::string nori_camera =
    "<camera type=\"perspective\"><integer name=\"width\" value=\"4\"/>"
    "<integer name=\"height\" value=\"3\"/></camera>";

inline Description parse_nori_text(const std::string& text, const std::string& folder = "",
                                   bool is_strict = false) {
  LoadOptions options;
  options.is_strict = is_strict;
  return parse_nori(text, "test.xml", folder, options);
}

/// A scene with a camera; the text begins on line 2.
inline Description parse_in_nori(const std::string& inside) {
  return parse_nori_text("<scene>" + nori_camera + "\n" + inside + "\n</scene>");
}

/// What stands for a bsdf, on a ball.
inline std::shared_ptr<Object> nori_bsdf(const std::string& bsdf) {
  return bsdf_of(parse_in_nori("<mesh type=\"sphere\">" + bsdf + "</mesh>"));
}

}  // namespace kaustik::nori
