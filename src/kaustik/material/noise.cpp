#include "kaustik/material/noise.h"

#include <algorithm>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// A hash of a cell's place in a grid; `Word` is a number, or several in the lanes of a vector.
template <class Word>
struct CellHash {
  CellHash(uint32_t seed, Word x, Word y) {
    Word h = seed * 0x9e3779b9u + x * 0x8da6b343u;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du + y * 0xd8163841u;
    column = (h ^ (h >> 13)) * 0x297a2d39u;
  }
  Word at(uint32_t z) const {
    Word h = column + z * 0xcb1ab31fu;
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
  }
  Word column;
};

using Lanes = float __attribute__((vector_size(16)));
using Words = uint32_t __attribute__((vector_size(16)));
using LaneMask = int32_t __attribute__((vector_size(16)));

Lanes with_sign(Lanes x, Words sign_bit) { return Lanes(Words(x) ^ (sign_bit & 0x80000000u)); }
Lanes where(LaneMask mask, Lanes x) { return Lanes(mask & LaneMask(x)); }
float sum_of(Lanes x) { return (x[0] + x[1]) + (x[2] + x[3]); }

/// The directions at four corners: to the middles of a cube's edges, each of them the sum of two
/// axes with signs. The twelve are not quite equally frequent; all that noise needs of them is that
/// they are even.
struct EdgeDirections {
  explicit EdgeDirections(Words hash) {
    const Words number = hash >> 28;
    const LaneMask is_xy = (number < 4) | ((number & 14) == 12);
    along_x = (number < 8) | is_xy;
    along_y = is_xy;
    const LaneMask last = number >= 14;
    first_sign = last ? Words(last) : hash << 3;
    second_sign = last ? hash << 3 : hash << 2;
  }
  /// Products with vectors of these components.
  Lanes dot(Lanes x, Lanes y, Lanes z) const {
    return with_sign(along_x ? x : y, first_sign) + with_sign(along_y ? y : z, second_sign);
  }
  /// The sums over the corners of direction times weight.
  Vec3f weighted_sum(Lanes weight) const {
    const Lanes first = with_sign(weight, first_sign), second = with_sign(weight, second_sign);
    return {sum_of(where(along_x, first)), sum_of(where(~along_x, first) + where(along_y, second)),
            sum_of(where(~along_y, second))};
  }

  LaneMask along_x, along_y;  ///< first axis x, else y; second axis y, else z
  Words first_sign, second_sign;
};

/// 6t⁵ − 15t⁴ + 10t³ and its derivative.
float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }
float fade_slope(float t) { return 30 * t * t * (t * (t - 2) + 1); }

/// Far from the origin floats have lost the fraction anyway; this keeps cells in the range of int.
float in_range(float x) { return std::clamp(x, -1e9f, 1e9f); }

/// The cell around a point, with its lower and its upper four corners in the lanes of vectors.
struct NoiseCell {
  NoiseCell(const Vec3f& p, uint32_t seed) {
    const Vec3f q(in_range(p.x), in_range(p.y), in_range(p.z));
    const Vec3f corner(std::floor(q.x), std::floor(q.y), std::floor(q.z));
    f = q - corner;
    const uint32_t x = uint32_t(lattice_cell(corner.x)), y = uint32_t(lattice_cell(corner.y)),
                   z = uint32_t(lattice_cell(corner.z));
    const CellHash<Words> column(seed, Words{x, x + 1, x, x + 1}, Words{y, y, y + 1, y + 1});
    below = column.at(z);
    above = column.at(z + 1);
    const float u = fade(f.x), v = fade(f.y);
    upper = fade(f.z);
    weight_x = Lanes{1 - u, u, 1 - u, u};
    weight_y = Lanes{1 - v, 1 - v, v, v};
  }
  Lanes value_below(const EdgeDirections& directions) const { return products(directions, f.z); }
  Lanes value_above(const EdgeDirections& directions) const {
    return products(directions, f.z - 1);
  }
  /// By bits 28 to 31 of the hashes, shifted left before.
  float value(int shift) const {
    return sum_of(weight_x * weight_y *
                  ((1 - upper) * value_below(EdgeDirections(below << shift)) +
                   upper * value_above(EdgeDirections(above << shift))));
  }

  Vec3f f;  ///< place in the cell
  Words below, above;
  Lanes weight_x, weight_y;
  float upper;  ///< weight of the upper corners

 private:
  Lanes products(const EdgeDirections& directions, float z) const {
    return directions.dot(Lanes{f.x, f.x - 1, f.x, f.x - 1}, Lanes{f.y, f.y, f.y - 1, f.y - 1},
                          Lanes{z, z, z, z});
  }
};

}  // namespace

NoiseValue gradient_noise(const Vec3f& p, uint32_t seed) {
  const NoiseCell cell(p, seed);
  const EdgeDirections below(cell.below), above(cell.above);
  const Lanes value_below = cell.value_below(below), value_above = cell.value_above(above);
  const Lanes weight = cell.weight_x * cell.weight_y;
  const Lanes value = (1 - cell.upper) * value_below + cell.upper * value_above;
  constexpr Lanes sign_x{-1, 1, -1, 1}, sign_y{-1, -1, 1, 1};
  return {sum_of(weight * value),
          below.weighted_sum((1 - cell.upper) * weight) + above.weighted_sum(cell.upper * weight) +
              Vec3f(fade_slope(cell.f.x) * sum_of(sign_x * cell.weight_y * value),
                    fade_slope(cell.f.y) * sum_of(sign_y * cell.weight_x * value),
                    fade_slope(cell.f.z) * sum_of(weight * (value_above - value_below)))};
}

float gradient_noise_value(const Vec3f& p, uint32_t seed) { return NoiseCell(p, seed).value(0); }

Vec3f noise_vector(const Vec3f& p, uint32_t seed) {
  const NoiseCell cell(p, seed);
  return {cell.value(0), cell.value(6), cell.value(12)};
}

namespace {

/// How often values of noise are within narrow bins, and their sums.
struct NoiseHistogram {
  static constexpr int bins = 8192;
  static constexpr float largest = 1.2f;
  std::vector<double> counts = std::vector<double>(bins), sums = counts;

  void add(float value) {
    const int bin = to_integer((value / largest + 1) * (bins / 2), 0, bins - 1);
    ++counts[size_t(bin)];
    sums[size_t(bin)] += double(value);
  }
};

NoiseClasses classes_of(const NoiseHistogram& histogram, double count_of_class) {
  NoiseClasses means{};
  size_t i = 0;
  double room = count_of_class, sum = 0;
  for (size_t bin = 0; bin < size_t(NoiseHistogram::bins); ++bin) {
    double left = histogram.counts[bin];
    while (left > 0) {
      const double part = std::min(left, room);
      sum += histogram.sums[bin] * part / histogram.counts[bin];
      left -= part;
      room -= part;
      if (room > 0) continue;
      means[i++] = float(sum / count_of_class);
      room = count_of_class;
      sum = 0;
    }
  }
  return means;
}

}  // namespace

const NoiseClasses& noise_classes() {
  static const NoiseClasses classes = [] {
    constexpr uint32_t samples = 1 << 20;
    NoiseHistogram histogram;
    for (uint32_t i = 0; i < samples; ++i) {
      Sampler sampler = Sampler::of(Quadrature::noise_class, i);
      const Vec2f u = sampler.next_2d();
      const float value = gradient_noise_value({u.x, u.y, sampler.next_1d()}, i);
      // The noise is symmetrical over space.
      histogram.add(value);
      histogram.add(-value);
    }
    return classes_of(histogram, 2.0 * samples / double(NoiseClasses().size()));
  }();
  return classes;
}

namespace {

/// An offset of its own keeps the octaves' zeros, at the corners of their cells, apart.
Vec3f octave_place(const Vec3f& p, int i, float frequency) {
  return p * frequency + Vec3f(1.7f, 9.2f, 5.3f) * float(i);
}

}  // namespace

template <class Value, class Noise>
Value FractalNoise::octave_sum(Value sum, const Vec3f& p, float width, const Noise& noise) const {
  float strength = 1, strengths = 0, frequency = 1;
  for (int i = 0; i < octaves; ++i, frequency *= 2, strength *= gain) {
    strengths += strength;
    const float visible = strength * noise_visibility(width * frequency);
    if (visible < 1e-4f) continue;
    sum = sum + noise(octave_place(p, i, frequency), seed + uint32_t(i), frequency) * visible;
  }
  return sum * (1 / strengths);
}

NoiseValue FractalNoise::operator()(const Vec3f& p, float width) const {
  return octave_sum(NoiseValue{}, p, width, [](const Vec3f& at, uint32_t of, float frequency) {
    const NoiseValue octave = gradient_noise(at, of);
    return NoiseValue{octave.value, octave.gradient * frequency};
  });
}

float FractalNoise::value(const Vec3f& p, float width) const {
  return octave_sum(0.0f, p, width, [](const Vec3f& at, uint32_t of, float) {
    return gradient_noise_value(at, of);
  });
}

Vec3f FractalNoise::vector(const Vec3f& p, float width) const {
  return octave_sum(Vec3f(0.0f), p, width,
                    [](const Vec3f& at, uint32_t of, float) { return noise_vector(at, of); });
}

float FractalNoise::share(int i) const {
  float strength = 1, strengths = 0, of_octave = 0;
  for (int j = 0; j < octaves; ++j, strength *= gain) {
    strengths += strength;
    if (j == i) of_octave = strength;
  }
  return of_octave / strengths;
}

float FractalNoise::octave(int i, const Vec3f& p) const {
  return share(i) *
         gradient_noise_value(octave_place(p, i, std::exp2(float(i))), seed + uint32_t(i));
}

float cell_random(int x, int y, int z, uint32_t seed) {
  return float(CellHash<uint32_t>(seed, uint32_t(x), uint32_t(y)).at(uint32_t(z)) >> 8) * 0x1p-24f;
}

}  // namespace kaustik
