#pragma once
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Of values of blocks of pixels, row by row: means over each block and those around it, as far as
/// `reach` on either side and as there are any.
std::vector<double> means_around(const std::vector<double>& values, const Vec2i& blocks, int reach);

/// What is above the largest values, a share of `outliers` of all, counts as the largest of the
/// others: single samples that happen upon a lamp say little of the picture.
void clip_outliers(std::vector<double>& values, double outliers);

}  // namespace kaustik
