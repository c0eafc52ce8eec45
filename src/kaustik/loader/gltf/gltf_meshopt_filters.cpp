// What becomes of attributes that are unpacked: appendix B of the specification of
// EXT_meshopt_compression.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "kaustik/loader/gltf/gltf_meshopt.h"

namespace kaustik::gltf {
namespace {

template <typename T>
T rounded(float share) {
  const float most = float(std::numeric_limits<T>::max());
  const float number = std::round(share * most);
  return std::isfinite(number) ? T(std::clamp(number, -most, most)) : T(0);
}

/// Unit vectors, which lie on an octahedron; the third number is what stands for 1.
template <typename T>
void unfold_octahedron(std::vector<uint8_t>& bytes) {
  for (size_t at = 0; at + 4 * sizeof(T) <= bytes.size(); at += 4 * sizeof(T)) {
    T parts[4];
    std::memcpy(parts, &bytes[at], sizeof parts);
    const float one = parts[2];
    float x = float(parts[0]) / one, y = float(parts[1]) / one;
    const float z = 1 - std::fabs(x) - std::fabs(y), beyond = std::min(z, 0.0f);
    x -= std::copysign(beyond, x);
    y -= std::copysign(beyond, y);
    const float length = std::sqrt(x * x + y * y + z * z);
    parts[0] = rounded<T>(x / length);
    parts[1] = rounded<T>(y / length);
    parts[2] = rounded<T>(z / length);
    std::memcpy(&bytes[at], parts, sizeof parts);
  }
}

/// Quaternions without their largest part; the fourth number is what stands for 1, and in its two
/// lowest bits which part that is.
void complete_quaternions(std::vector<uint8_t>& bytes) {
  constexpr float range = 1 / std::numbers::sqrt2_v<float>;
  for (size_t at = 0; at + 8 <= bytes.size(); at += 8) {
    int16_t given[4], parts[4];
    std::memcpy(given, &bytes[at], sizeof given);
    const float one = float(given[3] | 3);
    const int largest = given[3] & 3;
    float rest = 1;
    for (int i = 0; i < 3; ++i) {
      const float part = float(given[i]) / one * range;
      rest -= part * part;
      parts[(largest + 1 + i) % 4] = rounded<int16_t>(part);
    }
    parts[largest] = rounded<int16_t>(std::sqrt(std::max(rest, 0.0f)));
    std::memcpy(&bytes[at], parts, sizeof parts);
  }
}

/// Floats: eight bits of an exponent of two, above 24 bits of a factor.
void raise_exponents(std::vector<uint8_t>& bytes) {
  for (size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    uint32_t word;
    std::memcpy(&word, &bytes[at], sizeof word);
    const int exponent = int32_t(word) >> 24, factor = int32_t(word << 8) >> 8;
    const float number = std::ldexp(float(factor), exponent);
    std::memcpy(&bytes[at], &number, sizeof number);
  }
}

}  // namespace

void apply_meshopt_filter(MeshoptFilter filter, size_t stride, std::vector<uint8_t>& bytes) {
  if (filter == MeshoptFilter::octahedral)
    stride == 4 ? unfold_octahedron<int8_t>(bytes) : unfold_octahedron<int16_t>(bytes);
  if (filter == MeshoptFilter::quaternion) complete_quaternions(bytes);
  if (filter == MeshoptFilter::exponential) raise_exponents(bytes);
}

}  // namespace kaustik::gltf
