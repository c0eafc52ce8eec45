#include "kaustik/image/eye_model.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/base/to_integer.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/vision.h"

namespace kaustik {
namespace {

/// Share of the light that reaches the fovea without being scattered (Moon and Spencer 1945).
constexpr float unscattered = 0.913f;

/// Toward (u, v) in [0, 1]² over the picture, on the plane at distance 1.
Vec3f on_plane(const Picture& picture, float u, float v) {
  return {(2 * u - 1) * picture.half_width, (1 - 2 * v) * picture.half_height, 1};
}

std::vector<Vec3f> directions(const Grid<Vec3f>& grid, const Picture& picture) {
  std::vector<Vec3f> result;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      result.push_back(normalize(on_plane(picture, (float(column) + 0.5f) / float(grid.columns),
                                          (float(row) + 0.5f) / float(grid.rows))));
  return result;
}

/// The means of blocks of cells, so many in each that at most `most_cells` blocks are left.
Grid<Vec3f> joined(const Grid<Vec3f>& grid, int most_cells) {
  int block = 1;
  const auto blocks = [&](int cells) { return (cells + block - 1) / block; };
  while (int64_t(blocks(grid.columns)) * blocks(grid.rows) > most_cells) ++block;
  Grid<Vec3f> result{blocks(grid.columns), blocks(grid.rows), {}};
  // Equal parts, so that the blocks' places are those of a regular grid.
  for (int row = 0; row < result.rows; ++row)
    for (int column = 0; column < result.columns; ++column) {
      const auto border = [](int i, int parts, int cells) {
        return int(int64_t(i) * cells / parts);
      };
      Vec3f sum(0);
      int count = 0;
      for (int y = border(row, result.rows, grid.rows); y < border(row + 1, result.rows, grid.rows);
           ++y)
        for (int x = border(column, result.columns, grid.columns);
             x < border(column + 1, result.columns, grid.columns); ++x, ++count)
          sum += grid.at(x, y);
      result.cells.push_back(sum / float(count));
    }
  return result;
}

/// Level 0 is the picture; each next one has the means of 2 × 2 pixels of the one before.
std::vector<Grid<Vec3f>> pyramid(const Picture& picture, int levels) {
  std::vector<Grid<Vec3f>> result;
  result.push_back({picture.width, picture.height, picture.pixels});
  while (int(result.size()) < levels) {
    const Grid<Vec3f>& fine = result.back();
    if (fine.columns == 1 && fine.rows == 1) break;
    Grid<Vec3f> coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}};
    for (int y = 0; y < coarse.rows; ++y)
      for (int x = 0; x < coarse.columns; ++x) {
        const int x1 = std::min(2 * x + 1, fine.columns - 1);
        const int y1 = std::min(2 * y + 1, fine.rows - 1);
        coarse.cells.push_back(
            (fine.at(2 * x, 2 * y) + fine.at(x1, 2 * y) + fine.at(2 * x, y1) + fine.at(x1, y1)) *
            0.25f);
      }
    result.push_back(std::move(coarse));
  }
  return result;
}

/// How many octaves of the pyramid the eye cannot resolve, for each cell; 0: it sees each pixel.
Grid<float> lost_octaves(const Grid<Vec3f>& foveal, const Picture& picture) {
  Grid<float> result{foveal.columns, foveal.rows, {}};
  const float pixel_area =
      4 * picture.half_width * picture.half_height / float(picture.pixel_count());
  const std::vector<Vec3f> toward = directions(foveal, picture);
  for (size_t i = 0; i < toward.size(); ++i) {
    const float cosine = toward[i].z;
    const float pixel_degrees = std::sqrt(pixel_area * cosine * cosine * cosine) * 180 / pi;
    const double cycles = visual_acuity(double(luminance(foveal.cells[i])));
    result.cells.push_back(
        std::max(0.0f, -std::log2(float(2 * cycles) * std::max(pixel_degrees, 1e-20f))));
  }
  return result;
}

}  // namespace

Grid<Vec3f> veil(const Grid<Vec3f>& foveal, const Picture& picture) {
  constexpr int most_cells = 12000;
  Grid<Vec3f> result = joined(foveal, most_cells);
  const std::vector<Vec3f> light = result.cells;
  const std::vector<Vec3f> toward = directions(result, picture);
  constexpr size_t cells_per_block = 16;
  parallel_blocks(light.size(), cells_per_block, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      Vec3d sum(0);
      double weights = 0;
      for (size_t j = 0; j < light.size(); ++j) {
        const float cosine = dot(toward[i], toward[j]);
        if (j == i || cosine <= 0) continue;
        const double angle = 2 * std::asin(std::min(1.0f, length(toward[i] - toward[j]) / 2));
        const double weight = double(cosine) / (angle * angle);
        sum += Vec3d(light[j]) * weight;
        weights += weight;
      }
      result.cells[i] = weights > 0 ? Vec3f(sum * (double(1 - unscattered) / weights)) : Vec3f(0);
    }
  });
  return result;
}

void add_veil(Picture& picture, const Grid<Vec3f>& veil) {
  if (veil.cells.size() < 2) return;
  const float columns_per_pixel = float(veil.columns) / float(picture.width);
  const float rows_per_pixel = float(veil.rows) / float(picture.height);
  size_t i = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x, ++i)
      picture.pixels[i] =
          picture.pixels[i] * unscattered + veil.interpolated((float(x) + 0.5f) * columns_per_pixel,
                                                              (float(y) + 0.5f) * rows_per_pixel);
}

void blur_to_acuity(Picture& picture, const Grid<Vec3f>& foveal) {
  const Grid<float> octaves = lost_octaves(foveal, picture);
  const float most = *std::max_element(octaves.cells.begin(), octaves.cells.end());
  if (most == 0) return;
  const std::vector<Grid<Vec3f>> levels = pyramid(picture, to_integer(most, 0, 30) + 2);
  const float columns_per_pixel = float(foveal.columns) / float(picture.width);
  const float rows_per_pixel = float(foveal.rows) / float(picture.height);
  size_t i = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x, ++i) {
      const float cx = float(x) + 0.5f, cy = float(y) + 0.5f;
      const float octave =
          std::min(octaves.interpolated(cx * columns_per_pixel, cy * rows_per_pixel),
                   float(levels.size() - 1));
      const auto finer = to_integer<size_t>(octave, 0, levels.size() - 1);
      const size_t coarser = std::min(finer + 1, levels.size() - 1);
      const auto read = [&](size_t level) {
        const float scale = 1 / float(size_t(1) << level);
        return levels[level].interpolated(cx * scale, cy * scale);
      };
      const float part = octave - float(finer);
      picture.pixels[i] = read(finer) * (1 - part) + read(coarser) * part;
    }
}

}  // namespace kaustik
