#include "kaustik/material/mip_pyramid.h"

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// What pictures may end in.
const Spectrum black_border = spectrum_from_rgb(0, 0, 0), white_border = spectrum_from_rgb(1, 1, 1);

/// Indices of what is no texel.
constexpr int black_index = -1, white_index = -2;

/// Index inside [0, count), or of what lies beyond, for any integer.
int wrapped_index(int i, int count, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::clamp(i, 0, count - 1);
  if (wrap == Wrap::zero || wrap == Wrap::one)
    return i >= 0 && i < count ? i : wrap == Wrap::zero ? black_index : white_index;
  const int period = wrap == Wrap::mirror ? 2 * count : count;
  int rest = i % period;
  if (rest < 0) rest += period;
  return rest < count ? rest : period - 1 - rest;
}

/// Texels of a row of `from` that make texel `i` of a row of `to`, by the lengths that they share.
template <typename Visit>
void visit_parts(int i, int to, int from, const Visit& visit) {
  const double ratio = double(from) / double(to);
  const double begin = i * ratio, end = (i + 1) * ratio;
  for (int j = int(begin); j < from && double(j) < end; ++j) {
    const double part = std::min(end, j + 1.0) - std::max(begin, double(j));
    if (part > 0) visit(j, float(part / ratio));
  }
}

}  // namespace

MipPyramid::MipPyramid(int width, int height, std::vector<Spectrum> texels, const Wraps& wraps)
    : wraps_(wraps) {
  levels_.push_back({width, height, std::move(texels)});
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    std::vector<Spectrum> narrow(size_t(coarse.width) * size_t(fine.height));
    for (int y = 0; y < fine.height; ++y)
      for (int x = 0; x < coarse.width; ++x)
        visit_parts(x, coarse.width, fine.width, [&](int from, float share) {
          narrow[size_t(y) * size_t(coarse.width) + size_t(x)] +=
              fine.texels[size_t(y) * size_t(fine.width) + size_t(from)] * share;
        });
    coarse.texels.resize(size_t(coarse.width) * size_t(coarse.height));
    for (int y = 0; y < coarse.height; ++y)
      visit_parts(y, coarse.height, fine.height, [&](int from, float share) {
        for (int x = 0; x < coarse.width; ++x)
          coarse.texels[size_t(y) * size_t(coarse.width) + size_t(x)] +=
              narrow[size_t(from) * size_t(coarse.width) + size_t(x)] * share;
      });
    levels_.push_back(std::move(coarse));
  }
}

Vec2f MipPyramid::wrapped(const Vec2f& uv) const {
  // Far away the coordinates have lost the fraction anyway; this keeps them in the range of int.
  const auto in_period = [](float x, Wrap wrap) {
    const bool has_period = wrap == Wrap::repeat || wrap == Wrap::mirror;
    return has_period ? x - 2 * std::floor(0.5f * x) : std::clamp(x, -1.0f, 2.0f);
  };
  return {in_period(uv.x, wraps_.u), in_period(uv.y, wraps_.v)};
}

const Spectrum& MipPyramid::texel(const Level& level, int x, int y) const {
  const int column = wrapped_index(x, level.width, wraps_.u);
  const int row = wrapped_index(y, level.height, wraps_.v);
  if ((column | row) < 0) [[unlikely]]
    return std::min(column, row) == black_index ? black_border : white_border;
  return level.texels[size_t(row) * size_t(level.width) + size_t(column)];
}

const Spectrum& MipPyramid::nearest(const Vec2f& uv) const {
  const Vec2f p = wrapped(uv);
  const Level& level = levels_.front();
  return texel(level, lattice_cell(p.x * float(level.width)),
               lattice_cell(p.y * float(level.height)));
}

Spectrum MipPyramid::bilinear(const Level& level, const Vec2f& uv) const {
  const Vec2f p = wrapped(uv);
  const float x = p.x * float(level.width) - 0.5f, y = p.y * float(level.height) - 0.5f;
  const float left = std::floor(x), upper = std::floor(y);
  const float fx = x - left, fy = y - upper;
  const int ix = lattice_cell(left), iy = lattice_cell(upper);
  const Spectrum a = texel(level, ix, iy) * (1 - fx) + texel(level, ix + 1, iy) * fx;
  const Spectrum b = texel(level, ix, iy + 1) * (1 - fx) + texel(level, ix + 1, iy + 1) * fx;
  return a * (1 - fy) + b * fy;
}

float MipPyramid::level_of(const Vec2f& uv_width) const {
  const float texels = std::max(uv_width.x * float(levels_.front().width),
                                uv_width.y * float(levels_.front().height));
  if (!(texels > 1)) return 0;
  return std::min(std::log2(texels), float(levels_.size() - 1));
}

Spectrum MipPyramid::filtered(const Vec2f& uv, const Vec2f& uv_width) const {
  const float level = level_of(uv_width);
  const auto lower = size_t(level);
  const Spectrum fine = bilinear(levels_[lower], uv);
  const float rest = level - float(lower);
  if (rest == 0) return fine;
  return fine * (1 - rest) + bilinear(levels_[lower + 1], uv) * rest;
}

Vec2f MipPyramid::texel_size(const Vec2f& uv_width) const {
  const float texels = std::exp2(level_of(uv_width));
  return {std::min(1.0f, texels / float(levels_.front().width)),
          std::min(1.0f, texels / float(levels_.front().height))};
}

}  // namespace kaustik
