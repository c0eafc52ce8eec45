#pragma once
// Transforms as Radiance has them: turns, shifts, mirrors and one scale for all axes.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kaustik/base/transform.h"
#include "kaustik/loader/radiance/command_line.h"

namespace kaustik::radiance {

/// In double precision.
Vec3d placed_point(const Transform& transform, const Vec3d& point);
Vec3d placed_vector(const Transform& transform, const Vec3d& vector);
/// By how much lengths grow.
double scale_of(const Transform& transform);
inline bool is_mirrored(const Transform& transform) { return transform.determinant3() < 0; }

/// What the options of an xform command come to.
struct Placing {
  std::vector<Transform> placements;    ///< one for each copy
  std::optional<std::string> modifier;  ///< of all surfaces (-m)
  bool is_inverted = false;             ///< surfaces face the other way (-I)
  std::vector<std::string> files;       ///< "": what another command writes
};

/// The lines of a file that holds arguments (-f).
using ArgumentLines = std::function<std::vector<std::string>(const std::string& file)>;

/// Most copies that one command places.
inline constexpr size_t most_placements = 100'000;

/// Reads the arguments of xform: -t, -rx, -ry, -rz, -s, -mx, -my, -mz one after the other; -i
/// repeats what follows, -a does so 0, 1, … times. Throws Error(input) for what is wrong.
Placing read_xform(const Words& words, const Place& place, const ArgumentLines& lines_of);

/// Of the transform at the end of a pattern's strings, from `first` on. Nothing where it is wrong.
std::optional<Transform> transform_in(std::span<const std::string> strings);

}  // namespace kaustik::radiance
