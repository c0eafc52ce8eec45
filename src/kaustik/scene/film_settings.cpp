#include "kaustik/scene/film_settings.h"

#include "kaustik/base/to_integer.h"
#include "kaustik/base/warp.h"

namespace kaustik {
namespace {

constexpr size_t table_cells = 1024;

}  // namespace

PixelFilter::PixelFilter(Kind kind, float radius, float stddev)
    : kind_(kind), radius_(radius), stddev_(stddev) {
  if (kind_ != Kind::gaussian) return;
  // Mitsuba's windowed Gaussian: shifted down to reach zero at the radius.
  gaussian_offset_ = std::exp(-0.5f * sqr(radius_ / stddev_));
  const float mass = stddev_ * std::sqrt(2.0f * pi) *
                         std::erf(radius_ / (stddev_ * std::numbers::sqrt2_v<float>)) -
                     2.0f * radius_ * gaussian_offset_;
  gaussian_norm_ = 1.0f / mass;
  // The distribution function has no closed inverse with the offset.
  auto table = std::make_shared<Table>();
  float so_far = 0;
  for (size_t i = 0; i <= table_cells; ++i) {
    const float x = radius_ * (2 * float(i) / float(table_cells) - 1);
    const float gauss =
        stddev_ * std::sqrt(0.5f * pi) * std::erf(x / (stddev_ * std::numbers::sqrt2_v<float>));
    // By rounding the tails would not rise everywhere.
    so_far = std::clamp(0.5f + (gauss - x * gaussian_offset_) * gaussian_norm_, so_far, 1.0f);
    table->cdf.push_back(so_far);
  }
  table->cdf.front() = 0;
  table->cdf.back() = 1;
  for (size_t i = 0, cell = 0; i < table_cells; ++i) {
    while (table->cdf[cell + 1] <= float(i) / float(table_cells)) ++cell;
    table->guide.push_back(uint16_t(cell));
  }
  table_ = std::move(table);
}

float PixelFilter::eval_1d(float x) const {
  const float a = std::fabs(x);
  if (a > radius_) return 0;
  switch (kind_) {
    case Kind::box:
      return 0.5f / radius_;
    case Kind::tent:
      return (1.0f - a / radius_) / radius_;
    case Kind::gaussian:
      return (std::exp(-0.5f * sqr(x / stddev_)) - gaussian_offset_) * gaussian_norm_;
  }
  return 0;
}

float PixelFilter::sample_1d(float u) const {
  switch (kind_) {
    case Kind::box:
      return (2.0f * u - 1.0f) * radius_;
    case Kind::tent:
      return unit_to_tent(u) * radius_;
    case Kind::gaussian:
      break;
  }
  const std::vector<float>& cdf = table_->cdf;
  size_t cell = table_->guide[to_integer(u * float(table_cells), size_t(0), table_cells - 1)];
  while (cell + 1 < table_cells && cdf[cell + 1] <= u) ++cell;
  const float inside = (u - cdf[cell]) / (cdf[cell + 1] - cdf[cell]);
  return radius_ * (2 * (float(cell) + inside) / float(table_cells) - 1);
}

Vec2f PixelFilter::sample(const Vec2f& u) const { return {sample_1d(u.x), sample_1d(u.y)}; }

const std::vector<TypeInfo>& filter_infos() {
  static const std::vector<TypeInfo> infos{
      {"rfilter",
       "box",
       "Each sample counts for its own pixel.",
       {number_parameter("radius", 0.5, "Half width.").range(0.01, 16).in("pixels")}},
      {"rfilter",
       "tent",
       "Linear falloff.",
       {number_parameter("radius", 1.0, "Half width.").range(0.01, 16).in("pixels")}},
      {"rfilter",
       "gaussian",
       "Gaussian, cut off smoothly at four standard deviations.",
       {number_parameter("stddev", 0.5, "Standard deviation.").range(0.01, 4).in("pixels")}}};
  return infos;
}

const std::vector<TypeInfo>& sampler_infos() {
  static const std::vector<TypeInfo> infos = [] {
    std::vector<TypeInfo> list;
    for (const char* name : {"independent", "stratified", "multijitter", "orthogonal", "ldsampler"})
      list.push_back(
          {"sampler",
           name,
           "Kaustik has one sampler (Owen-scrambled Sobol points); only the count is used.",
           {integer_parameter("sample_count", 4, "Samples per pixel.").range(1, 1 << 24),
            ignored_parameter("seed", ParameterKind::integer),
            ignored_parameter("jitter", ParameterKind::boolean),
            ignored_parameter("dimension", ParameterKind::integer),
            ignored_parameter("strength", ParameterKind::integer),
            ignored_parameter("scramble", ParameterKind::integer)}});
    return list;
  }();
  return infos;
}

}  // namespace kaustik
