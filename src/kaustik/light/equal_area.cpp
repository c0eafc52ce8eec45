#include "kaustik/light/equal_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "kaustik/base/parallel.h"
#include "kaustik/base/vec.h"

namespace kaustik {
namespace {

/// Points in each pixel, along both sides; and where a lamp has an edge.
constexpr int usual_points = 4, edge_points = 24;
/// What is so much brighter than the whole picture is a lamp, and a pixel that is darker than what
/// is near has an edge of it.
constexpr float lamp_contrast = 4, edge_contrast = 1.02f;

/// Where on the unit square a direction lies whose third coordinate is the middle's; the inverse of
/// Clarberg's map of the square to the sphere.
Imath::V2d square_from(const Vec3d& d) {
  const double x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  // Over the square's own diamond: r from its middle, and the share of a quarter turn.
  const double r = std::sqrt(std::max(0.0, 1 - z));
  const double turn = std::atan2(y, x) * (2 / std::numbers::pi);
  double v = turn * r, u = r - v;
  if (d.z < 0) {
    const double mirrored = 1 - v;
    v = 1 - u;
    u = mirrored;
  }
  return {0.5 * (1 + std::copysign(u, d.x)), 0.5 * (1 + std::copysign(v, d.y))};
}

/// Cosine of the angle from +y at which a row of nodes stands; those beyond the poles stand there.
double height_of(int row, int rows) {
  return std::cos(std::numbers::pi * std::clamp(row, 0, rows - 1) / (rows - 1));
}

/// The part of the sphere for which a node of the result stands, where values between nodes are
/// bilinear in turn and height.
struct Cell {
  int column, width;
  double top, bottom;  ///< heights

  Cell(int node_column, int node_row, int nodes_across, int rows)
      : column(node_column),
        width(nodes_across),
        top(0.5 * (height_of(node_row - 1, rows) + height_of(node_row, rows))),
        bottom(0.5 * (height_of(node_row, rows) + height_of(node_row + 1, rows))) {}

  /// Of points² ones, evenly over the cell.
  Imath::V2d point(int i, int points) const {
    const double across = (column + (i % points + 0.5) / points) / width;
    const double height = std::lerp(top, bottom, (i / points + 0.5) / points);
    const double phi = 2 * std::numbers::pi * across;
    const double radius = std::sqrt(std::max(0.0, 1 - height * height));
    const Vec3d d(radius * std::sin(phi), height, -radius * std::cos(phi));
    return square_from({d.x, -d.z, d.y});
  }
};

size_t pixel_at(const Imath::V2d& at, int size) {
  const size_t column = size_t(std::clamp(int(at.x * size), 0, size - 1));
  return size_t(std::clamp(int(at.y * size), 0, size - 1)) * size_t(size) + column;
}

/// Beyond an edge of the square its mirror image about the edge's middle goes on.
size_t pixel_near(int column, int row, int size) {
  if (column < 0 || column >= size) row = size - 1 - row;
  if (row < 0 || row >= size) column = size - 1 - column;
  return size_t(std::clamp(row, 0, size - 1)) * size_t(size) +
         size_t(std::clamp(column, 0, size - 1));
}

/// Of each pixel and its neighbours the brightest value of all channels; 0 where none is a lamp.
std::vector<float> lamps_near(const Image& square) {
  const int size = square.width();
  std::vector<float> single(square.pixel_count(), 0), brightest(square.pixel_count(), 0);
  for (int c = 0; c < square.channel_count(); ++c)
    for (size_t i = 0; i < single.size(); ++i)
      single[i] = std::max(single[i], square.channel(c)[i]);
  const double sum = std::accumulate(single.begin(), single.end(), 0.0);
  const float least = lamp_contrast * float(sum / double(single.size()));
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      float& most = brightest[pixel_near(column, row, size)];
      for (int i = 0; i < 9; ++i)
        most = std::max(most, single[pixel_near(column + i % 3 - 1, row + i / 3 - 1, size)]);
      if (most < least) most = 0;
    }
  return brightest;
}

/// The mean of a cell's points, for all channels.
std::vector<float> mean_over(const Image& square, const std::vector<float>& lamps,
                             const Cell& cell) {
  std::vector<float> mean(size_t(square.channel_count()));
  for (const int points : {usual_points, edge_points}) {
    std::ranges::fill(mean, 0.0f);
    float brightest = 0, sum = 0;
    for (int i = 0; i < points * points; ++i) {
      const size_t from = pixel_at(cell.point(i, points), square.width());
      for (int c = 0; c < square.channel_count(); ++c) {
        const float value = square.channel(c)[from];
        mean[size_t(c)] += value * (1.0f / float(points * points));
      }
      brightest = std::max(brightest, lamps[from]);
    }
    for (const float value : mean) sum = std::max(sum, value);
    if (brightest <= edge_contrast * sum) break;
  }
  return mean;
}

/// Scales each channel so that the whole sphere sends as much light as in the square picture.
void keep_light(Image& latlong, const Image& square) {
  for (int c = 0; c < latlong.channel_count(); ++c) {
    double wanted = 0, is = 0;
    for (const float value : square.channel(c)) wanted += value;
    wanted /= double(square.pixel_count());
    for (int y = 0; y < latlong.height(); ++y) {
      double sum = 0;
      for (int x = 0; x < latlong.width(); ++x) sum += latlong.at(x, y, c);
      const Cell cell(0, y, latlong.width(), latlong.height());
      is += 0.5 * (cell.top - cell.bottom) * sum / latlong.width();
    }
    if (!(is > 0)) continue;
    for (float& value : latlong.channel(c)) value *= float(wanted / is);
  }
}

}  // namespace

Image latlong_of_equal_area(const Image& square) {
  const int size = square.width();
  Image result(2 * size, std::max(size, 2), square.channel_names());
  const int width = result.width(), rows = result.height();
  const std::vector<float> lamps = lamps_near(square);
  parallel_blocks(size_t(rows), 4, [&](size_t begin, size_t end, size_t) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < width; ++x) {
        const std::vector<float> mean = mean_over(square, lamps, Cell(x, y, width, rows));
        for (int c = 0; c < result.channel_count(); ++c) result.at(x, y, c) = mean[size_t(c)];
      }
  });
  keep_light(result, square);
  return result;
}

}  // namespace kaustik
