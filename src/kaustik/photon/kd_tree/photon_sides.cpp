#include "kaustik/photon/kd_tree/photon_sides.h"

#include <cstring>

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

using Bytes = int8_t __attribute__((vector_size(16)));
using Words = int16_t __attribute__((vector_size(32)));

Words widen(const int8_t* values) {
  Bytes bytes;
  std::memcpy(&bytes, values, sizeof(bytes));
  return __builtin_convertvector(bytes, Words);
}

/// Bit i: element i is below zero.
uint32_t sign_bits(const Bytes& bytes) {
#ifdef __SSE2__
  using Chars = char __attribute__((vector_size(16)));
  return uint32_t(__builtin_ia32_pmovmskb128(Chars(bytes)));
#else
  uint32_t bits = 0;
  for (int i = 0; i < 16; ++i) bits |= uint32_t(bytes[i] < 0) << i;
  return bits;
#endif
}

}  // namespace

void PhotonSides::add(int8_t x, int8_t y, int8_t z, bool on_front) {
  const uint32_t lane = count_++ % block_size;
  std::vector<Block>& blocks = blocks_.own();
  if (lane == 0) blocks.emplace_back();
  Block& block = blocks.back();
  block.x[lane] = x;
  block.y[lane] = y;
  block.z[lane] = z;
  block.front = uint16_t(block.front | unsigned(on_front) << lane);
}

PhotonSides::Query PhotonSides::query(const Vec3f& normal, bool both_sides) {
  // 63 parts keep three products with 127 parts inside 16 bits.
  const auto parts = [](float v) { return to_integer<int16_t>(std::round(v * 63), -63, 63); };
  return {parts(normal.x), parts(normal.y), parts(normal.z), both_sides};
}

uint32_t PhotonSides::accept(const Query& query, uint32_t first, uint32_t mask) const {
  const Block& block = blocks_[first / block_size];
  const uint32_t shift = first % block_size;
  const Words dots = widen(block.x) * query.x + widen(block.y) * query.y + widen(block.z) * query.z;
  uint32_t same = sign_bits(__builtin_convertvector(dots > 0, Bytes));
  if (query.both_sides) {
    const uint32_t opposite = sign_bits(__builtin_convertvector(dots < 0, Bytes));
    same = (same & block.front) | (opposite & ~uint32_t(block.front));
  }
  return (same >> shift) & mask;
}

}  // namespace kaustik
