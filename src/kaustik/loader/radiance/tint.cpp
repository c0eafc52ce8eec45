#include "kaustik/loader/radiance/tint.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "kaustik/loader/radiance/cal_program.h"
#include "kaustik/loader/radiance/surface_parts.h"

namespace kaustik::radiance {
namespace {

bool are_alike(const Rgb& a, const Rgb& b) {
  const auto near = [](double x, double y) {
    return std::fabs(x - y) <= 1e-6 * (std::fabs(x) + std::fabs(y));
  };
  return near(a.r, b.r) && near(a.g, b.g) && near(a.b, b.b);
}

/// Of a ray that arrives over the front of the surface: even numbers give directions as often as
/// their cosine.
Vec3d direction_by(const Vec3d& normal, double share, double turn) {
  const double r = std::sqrt(share), phi = 2 * std::numbers::pi * turn;
  const auto [u, v] = across(normal);
  return -(u * (r * std::cos(phi)) + v * (r * std::sin(phi)) +
           normal * std::sqrt(std::max(0.0, 1 - r * r)));
}

Vec3d some_direction(const Vec3d& normal, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double share = unit(random);
  return direction_by(normal, share, unit(random));
}

/// Over points of the surface and directions, evenly by the golden ratio; what has no value there
/// counts for nothing.
std::optional<Rgb> mean_of(const Pattern& pattern, const std::vector<PatternPoint>& samples) {
  constexpr int count = 1024;
  Rgb sum;
  int good = 0;
  for (int i = 0; i < count; ++i) {
    PatternPoint point = samples[size_t(i) % samples.size()];
    const double turn = i * std::numbers::phi;
    point.direction = direction_by(point.normal, (i + 0.5) / count, turn - std::floor(turn));
    try {
      const Rgb value = pattern.at(point);
      sum = {sum.r + value.r, sum.g + value.g, sum.b + value.b};
      ++good;
    } catch (const CalError&) {
    }
  }
  if (good == 0) return std::nullopt;
  return times(sum, 1.0 / good);
}

enum class Variation { none, in_space, by_direction };

/// Found out by trial, around the points of the surface.
Variation variation_of(const Pattern& pattern, const std::vector<PatternPoint>& samples) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::optional<Rgb> first;
  Variation found = Variation::none;
  for (int i = 0; i < 48; ++i) {
    PatternPoint point = samples[size_t(i) % samples.size()];
    const double reach = i % 3 == 0 ? 0 : i % 3 == 1 ? 1 : 100;
    for (int axis = 0; axis < 3; ++axis) point.position[axis] += reach * unit(random);
    point.direction = some_direction(point.normal, random);
    PatternPoint turned = point;
    turned.direction = some_direction(point.normal, random);
    try {
      const Rgb value = pattern.at(point);
      if (!are_alike(value, pattern.at(turned))) return Variation::by_direction;
      if (!first) first = value;
      if (!are_alike(value, *first)) found = Variation::in_space;
    } catch (const CalError&) {
    }
  }
  return found;
}

}  // namespace

void TintReader::add(const Modifier& modifier, const std::vector<PatternPoint>& samples,
                     bool may_vary, bool is_lamp, Tint& tint) {
  const auto pattern = reader_.pattern(modifier);
  if (!pattern) return;
  const Variation variation = variation_of(*pattern, samples);
  if (variation == Variation::in_space && may_vary) {
    tint.in_space.push_back(pattern);
    return;
  }
  const auto mean = mean_of(*pattern, samples);
  const std::string name = name_of(*modifier.primitive);
  if (!mean) {
    deviations_.ignored(name, "the pattern is left out: it has no value on the surface",
                        modifier.place());
    return;
  }
  tint.factor = product(tint.factor, *mean);
  if (is_lamp && variation == Variation::by_direction) {
    tint.directed.emplace_back(pattern, &modifier);
    return;
  }
  tint.even_factor = product(tint.even_factor, *mean);
  if (variation != Variation::none)
    deviations_.approximated(name,
                             variation == Variation::in_space
                                 ? "the pattern counts by its mean on the first surface"
                                 : "the pattern depends on the direction of view, and counts by "
                                   "its mean",
                             modifier.place());
}

Tint TintReader::tint_of(const std::vector<const Modifier*>& patterns,
                         const std::vector<PatternPoint>& samples, bool may_have_pictures,
                         bool may_vary, bool is_lamp) {
  Tint tint;
  for (const Modifier* modifier : patterns) {
    if (!is_picture(*modifier)) {
      add(*modifier, samples, may_vary, is_lamp, tint);
      continue;
    }
    const auto picture = reader_.picture(*modifier);
    const std::string name = name_of(*modifier->primitive);
    if (!picture) continue;
    if (may_have_pictures && !tint.picture) {
      tint.picture = picture;
      tint.picture_modifier = modifier;
      for (size_t i = 0; i < 3; ++i)
        if (modifier->strings()[i] != std::array{"red", "green", "blue"}[i] &&
            modifier->strings()[i] != std::array{"clip_r", "clip_g", "clip_b"}[i] &&
            modifier->strings()[i] != "noop")
          deviations_.approximated(
              name, "the picture has its own colours: what the functions make of them is left out",
              modifier->place());
    } else {
      deviations_.ignored(name,
                          may_have_pictures
                              ? "a surface has one picture: this one is left out"
                              : "pictures are shown on polygons alone: this one is left out",
                          modifier->place());
    }
  }
  // A texture is one or the other.
  if (tint.picture && !tint.in_space.empty()) {
    for (const Modifier* modifier : patterns)
      if (!is_picture(*modifier))
        deviations_.ignored(name_of(*modifier->primitive),
                            "the pattern is left out beside a picture", modifier->place());
    tint.in_space.clear();
  }
  return tint;
}

std::string luminance_remark(const Rgb& c) {
  const double theirs = 0.265 * c.r + 0.670 * c.g + 0.065 * c.b;
  const double ours = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
  if (!(theirs > 0) || std::fabs(ours / theirs - 1) <= 0.01) return "";
  return fmt::format(
      "its red, green and blue are taken for those of Rec. 709: its luminance is {:.0f} % {} than "
      "in Radiance",
      100 * std::fabs(ours / theirs - 1), ours > theirs ? "higher" : "lower");
}

}  // namespace kaustik::radiance
