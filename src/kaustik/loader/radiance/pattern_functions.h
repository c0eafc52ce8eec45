#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/loader/radiance/cal_evaluator.h"
#include "kaustik/loader/radiance/patterns.h"
#include "kaustik/loader/radiance/placement.h"

namespace kaustik::radiance {

/// The functions of a modifier: its expressions with what its file defines.
class PatternFunctions {
 public:
  /// `source` is the text of the file. Throws CalError.
  PatternFunctions(std::string_view source, std::span<const std::string> expressions,
                   std::vector<double> reals, const Transform& world_from_own);
  PatternFunctions(const PatternFunctions&) = delete;  // what it holds refers to it
  PatternFunctions& operator=(const PatternFunctions&) = delete;

  /// Puts the point where the variables are: Px, Nx, Dx …
  void stand_at(const PatternPoint& point);
  /// Of an expression there. Throws CalError, also for what is not finite.
  double value(size_t expression);
  /// Of a function of numbers there; 'red', 'noop' and the like among them.
  double call(const std::string& name, std::span<const double> values);

 private:
  void set(const char* const (&names)[3], const Vec3d& v);

  CalProgram program_;
  std::vector<uint32_t> roots_;
  std::vector<double> reals_;
  Transform own_from_world_;
  std::optional<CalEvaluator> evaluator_;
};

}  // namespace kaustik::radiance
