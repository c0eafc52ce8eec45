#pragma once
// Patterns: what multiplies the colour of a material, by functions, tables and pictures.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/loader/radiance/cal_program.h"
#include "kaustik/loader/radiance/modifiers.h"
#include "kaustik/loader/radiance/scene_files.h"

namespace kaustik::radiance {

/// Where a pattern is asked for, in the world.
struct PatternPoint {
  Vec3d position;
  Vec3d normal{0, 0, 1};      ///< unit
  Vec3d direction{0, 0, -1};  ///< of the ray that comes from the eye, unit
  double u = 0, v = 0;        ///< of compiled meshes: their own coordinates
};

/// A factor on the colour. Not for several threads at once.
class Pattern {
 public:
  virtual ~Pattern() = default;
  /// Throws CalError where a function has no value there.
  virtual Rgb at(const PatternPoint& point) const = 0;
  /// Whether it may be asked often.
  virtual bool is_quick() const { return false; }
};

/// A picture on a surface, by coordinates along its width and height; its shorter side is 1 long.
class PicturePattern {
 public:
  virtual ~PicturePattern() = default;
  const std::string& file() const { return file_; }
  /// Throws CalError.
  virtual std::pair<double, double> place_of(const PatternPoint& point) const = 0;
  /// Whether the picture is repeated outside of itself.
  bool repeats = false;

 protected:
  explicit PicturePattern(std::string file) : file_(std::move(file)) {}

 private:
  std::string file_;
};

/// Reads them, each once.
class PatternReader {
 public:
  PatternReader(SceneFiles& files, Deviations& deviations)
      : files_(files), deviations_(deviations) {}

  /// Of a pattern, or of the first number of a mixture. Null where it cannot be had, which is told.
  std::shared_ptr<const Pattern> pattern(const Modifier& modifier);
  /// Of a file that a modifier names; nothing if there is none.
  std::optional<std::string> text_for(const std::string& name, const Modifier& modifier);
  /// Of a colorpict or mixpict. Null: likewise.
  std::shared_ptr<const PicturePattern> picture(const Modifier& modifier);

 private:
  void tell_left_out(const char* what, const CalError& why, const Modifier& modifier);
  std::shared_ptr<const Pattern> read_pattern(const Modifier& modifier);
  std::shared_ptr<const PicturePattern> read_picture(const Modifier& modifier);
  std::shared_ptr<const Pattern> read_spectrum(const Modifier& modifier);
  /// The source of a file of functions that a modifier names; "." is none.
  std::string function_source(const std::string& name, const Modifier& modifier);

  SceneFiles& files_;
  Deviations& deviations_;
  std::map<const Modifier*, std::shared_ptr<const Pattern>> patterns_;
  std::map<const Modifier*, std::shared_ptr<const PicturePattern>> pictures_;
};

/// Whether the modifier is a pattern or a mixture by a picture.
inline bool is_picture(const Modifier& modifier) {
  return modifier.type() == "colorpict" || modifier.type() == "mixpict";
}

}  // namespace kaustik::radiance
