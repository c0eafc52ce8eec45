#pragma once
#include <string>

#include "kaustik/base/parameters.h"

namespace kaustik {

/// Reads a spectrum from text: per line a wavelength in nm and a value; '#' starts a comment.
/// Throws Error(input), for a line that is wrong with its place; quotes nothing of the file, which
/// may be any that a scene names.
SpectralCurve read_spectrum_file(const std::string& path);

}  // namespace kaustik
