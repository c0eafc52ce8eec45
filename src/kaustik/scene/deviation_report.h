#pragma once
#include <string>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// "2 approximated, 1 ignored, 3 missing"; "" where the file is rendered as it is written.
std::string deviation_counts(const Description& description);

/// A line for each: "approximated: material 'wool': hair is rendered as … (scene.pbrt:12:3)".
std::vector<std::string> deviation_lines(const Description& description);

/// The counts with the first few of them, what is missing before all, and the command that tells
/// the others; "" where there are none.
std::string deviation_summary(const Description& description);

}  // namespace kaustik
