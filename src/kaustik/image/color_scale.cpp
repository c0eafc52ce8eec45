#include "kaustik/image/color_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/base/to_integer.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

constexpr double tiny = 1e-9;

/// The smallest of 1, 2, 5 times a power of ten that is not below `value` (positive) …
double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value) + tiny));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= value * (1 - tiny)) return factor * decade;
  return 10 * decade;
}
/// … and the largest that is not above.
double round_down(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value) + tiny));
  for (const double factor : {5.0, 2.0})
    if (factor * decade <= value * (1 + tiny)) return factor * decade;
  return decade;
}

/// The value below which `share` of the sorted values are; 0 of none.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[to_integer(share * double(sorted.size() - 1), size_t(0), sorted.size() - 1)];
}

void set_linear_limits(ColorScale& scale, const std::vector<double>& sorted,
                       const ScaleSettings& settings) {
  scale.minimum = settings.minimum.value_or(0);
  if (settings.maximum) {
    scale.maximum = *settings.maximum;
    return;
  }
  const double high = quantile(sorted, 0.98);
  // Nothing above the minimum: any range will do.
  const double extent =
      high > scale.minimum ? high - scale.minimum : std::max(1.0, std::fabs(scale.minimum));
  const double step = round_up(extent / 6);
  scale.maximum = scale.minimum + step * std::ceil(extent / step - tiny);
}

void set_logarithmic_limits(ColorScale& scale, const std::vector<double>& sorted,
                            const ScaleSettings& settings) {
  const double high = quantile(sorted, 0.98), low = quantile(sorted, 0.02);
  const double least = settings.minimum.value_or(0);
  scale.maximum = settings.maximum ? *settings.maximum
                  : high > least   ? round_up(high)
                                   : std::max(1.0, 10 * least);
  scale.minimum = settings.minimum
                      ? *settings.minimum
                      : round_down(std::clamp(low, scale.maximum * 1e-4, scale.maximum / 2));
}

std::vector<double> linear_ticks(const ColorScale& scale) {
  const double extent = scale.maximum - scale.minimum, step = round_up(extent / 6 * (1 - tiny));
  std::vector<double> ticks = {scale.minimum};
  for (double i = std::ceil(scale.minimum / step); i * step < scale.maximum; ++i)
    if (i * step - scale.minimum > 0.4 * step && scale.maximum - i * step > 0.4 * step)
      ticks.push_back(i * step);
  ticks.push_back(scale.maximum);
  return ticks;
}

std::vector<double> logarithmic_ticks(const ColorScale& scale) {
  const double decades = std::log10(scale.maximum / scale.minimum);
  // 1, 2, 5 as long as there is room for them, then only ever wider powers of ten.
  const int decades_apart = std::max(1, int(std::ceil(decades / 8)));
  std::vector<double> ticks = {scale.minimum};
  const int first = int(std::floor(std::log10(scale.minimum)));
  for (int n = first; n <= std::log10(scale.maximum); n += decades_apart)
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (decades > 4.01 && factor > 1) continue;
      const double tick = factor * std::pow(10.0, n);
      constexpr double closest = 1.25;
      if (tick > scale.minimum * closest && tick * closest < scale.maximum) ticks.push_back(tick);
    }
  ticks.push_back(scale.maximum);
  return ticks;
}

}  // namespace

Vec3f viridis(float t) {
  // Numbers 0, 17, 34, … 255 of the published 256 colours, sRGB encoded.
  static constexpr float table[][3] = {
      {0.267004f, 0.004874f, 0.329415f}, {0.282656f, 0.100196f, 0.422160f},
      {0.277134f, 0.185228f, 0.489898f}, {0.253935f, 0.265254f, 0.529983f},
      {0.221989f, 0.339161f, 0.548752f}, {0.190631f, 0.407061f, 0.556089f},
      {0.163625f, 0.471133f, 0.558148f}, {0.139147f, 0.533812f, 0.555298f},
      {0.120565f, 0.596422f, 0.543611f}, {0.134692f, 0.658636f, 0.517649f},
      {0.208030f, 0.718701f, 0.472873f}, {0.327796f, 0.773980f, 0.406640f},
      {0.477504f, 0.821444f, 0.318195f}, {0.647257f, 0.858400f, 0.209861f},
      {0.824940f, 0.884720f, 0.106217f}, {0.993248f, 0.906157f, 0.143936f}};
  constexpr int steps = int(std::size(table)) - 1;
  const float x = std::isnan(t) ? 0 : std::clamp(t, 0.0f, 1.0f) * steps;
  const int i = to_integer(x, 0, steps - 1);
  const float part = x - float(i);
  Vec3f result;
  for (int c = 0; c < 3; ++c)
    result[c] = linear_from_srgb(table[i][c] + part * (table[i + 1][c] - table[i][c]));
  return result;
}

double ColorScale::position(double value) const {
  if (!is_logarithmic) return (value - minimum) / (maximum - minimum);
  return value > 0 ? std::log(value / minimum) / std::log(maximum / minimum)
                   : -std::numeric_limits<double>::infinity();
}

size_t ColorScale::band(double value) const {
  size_t reached = 0;
  for (size_t i = 1; i + 1 < ticks.size(); ++i)
    if (value >= ticks[i]) ++reached;
  return reached;
}

ColorScale make_scale(std::vector<double> values, const ScaleSettings& settings) {
  std::erase_if(values, [](double value) { return !(value > 0); });
  std::sort(values.begin(), values.end());
  ColorScale scale;
  scale.is_logarithmic = settings.is_logarithmic;
  if (settings.is_logarithmic)
    set_logarithmic_limits(scale, values, settings);
  else
    set_linear_limits(scale, values, settings);
  if (settings.is_logarithmic && !(scale.minimum > 0))
    throw Error(ErrorKind::input,
                fmt::format("a logarithmic scale cannot start at {}", scale.minimum),
                "give a minimum above 0");
  if (!(scale.minimum < scale.maximum))
    throw Error(ErrorKind::input,
                fmt::format("the scale would go from {} to {}", scale.minimum, scale.maximum),
                "give a minimum below the maximum");
  scale.ticks = settings.is_logarithmic ? logarithmic_ticks(scale) : linear_ticks(scale);
  return scale;
}

}  // namespace kaustik
