#pragma once
#include "kaustik/base/parameters.h"
#include "kaustik/image/image_io.h"

namespace kaustik {

/// The picture that argument `filename` names, all its values finite and at least 0. Throws
/// Error(input) at the place of the file name where it cannot be read or holds other values: they
/// would poison every path that meets them.
Image read_picture_argument(const Arguments& arguments, const ReadOptions& options = {});

}  // namespace kaustik
