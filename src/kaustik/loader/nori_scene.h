#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/loader/load_options.h"
#include "kaustik/scene/description.h"

namespace kaustik {

// Scenes and tests of Nori, a renderer for teaching, and of its forks: docs/formats/nori.md.

/// Whether text begins as one of these: with <test>, or with a <scene> that has no version, a mesh
/// or a camera, and no tag of Mitsuba's.
bool is_nori(std::string_view head);
/// Reads a scene file, which gzip may have packed. Throws Error(input), also for files of tests.
Description load_nori(const std::string& path, const LoadOptions& options = {});
/// The same from text, see parse_scene().
Description parse_nori(std::string_view text, std::string name_for_messages,
                       const std::string& base_folder, const LoadOptions& options = {});

/// One claim of a file of tests, which is to be checked by statistics.
struct NoriTest {
  enum class Kind {
    radiance,     ///< the mean luminance of a scene's picture is `expected`
    reflectance,  ///< what a bsdf reflects of even light toward `angle_degrees` is `expected`
    density       ///< a bsdf draws directions as its density says
  };
  Kind kind = Kind::radiance;
  std::string name;  ///< for people: "scene on line 12"
  /// The scene; of the other kinds one whose only shape has the bsdf.
  Description description{nullptr};
  double expected = 0;
  double angle_degrees = 0;  ///< to the normal
  int64_t samples = 0;
  /// The p value at which the claim is rejected, such that all claims of the file together reject a
  /// true one with the chance that the file gives (Šidák).
  double level = 0.01;
  // Of densities alone.
  int rows = 10;                ///< of cells along the cosine; twice as many around
  double minimum_expected = 5;  ///< samples of a cell, below which it is pooled
  int direction = 0;            ///< number of the random direction of the light, from 0
  /// Why the claim cannot be checked; "": it can.
  std::string obstacle = {};
};

/// The claims of a file whose root is <test>; those of one bsdf follow one another. Throws
/// Error(input), also for other files.
std::vector<NoriTest> read_nori_tests(const std::string& path, const LoadOptions& options = {});

}  // namespace kaustik
