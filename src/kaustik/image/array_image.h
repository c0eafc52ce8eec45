#pragma once
#include "kaustik/base/array.h"
#include "kaustik/image/image_io.h"

namespace kaustik {

/// The picture of a buffer of [rows, columns] or [rows, columns, 1, 3 or 4] numbers, its upper left
/// pixel first: grey, colours, or colours and opacity. As in files, integers stand for values over
/// their maximum in sRGB, which is decoded or kept as `options` say, floats for linear ones. Throws
/// Error(input) for other extents and types, and for what check_image_size() refuses, Error(system)
/// for more memory than `options` allow.
Image image_of_array(const Array& array, const ReadOptions& options = {});

}  // namespace kaustik
