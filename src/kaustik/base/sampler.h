#pragma once
#include <cassert>
#include <cstdint>

#include "kaustik/base/draws.h"
#include "kaustik/base/sampler_details.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// 64-bit mix of two values (the finaliser of splitmix64); the base of every address.
constexpr uint64_t hash_mix(uint64_t a, uint64_t b) {
  uint64_t x = a + 0x9e3779b97f4a7c15ull * (b + 1);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Random numbers addressed by (scramble, index, dimension): the same address always gives the same
/// numbers, whoever asks. Over consecutive indices of one scramble each pair of dimensions is an
/// Owen-scrambled Sobol (0,2)-sequence, shuffled independently per pair (Burley, "Practical
/// Hash-based Owen Scrambling", JCGT 2020); past `stratified_pairs` pairs the numbers are
/// independent, since deep dimensions gain nothing from stratification.
class Sampler {
 public:
  /// Points that share a scramble stratify one another over `index`; different scrambles are
  /// independent.
  Sampler(uint64_t scramble, uint32_t index)
      : scramble_(scramble), index_(index), reversed_index_(sampler_details::reverse_bits(index)) {}

  /// The sampler of one path: all that tells paths apart goes into the address.
  static Sampler at(uint64_t seed, uint32_t replicate_or_pass, Stream stream, uint64_t element,
                    uint32_t index) {
    const StreamRow& row = row_of(stream);
    assert(element < row.count);
    const uint64_t a = hash_mix(seed, (uint64_t(row.of) << 32) | replicate_or_pass);
    return {hash_mix(a, row.first + element), index};
  }

  /// Point `index` of a quadrature; those of different `number` (below its row's count) are
  /// independent.
  static Sampler of(Quadrature use, uint32_t index, uint64_t number = 0) {
    const QuadratureRow& row = row_of(use);
    assert(number < row.count);
    return {row.first + number, index};
  }

  float next_1d() { return next_2d().x; }
  /// In [0, 1)².
  Vec2f next_2d();
  /// The same, but independent of what other indices have there: where stratification gains
  /// nothing. Takes less time.
  Vec2f next_independent_2d();

  /// As next_2d(), where the numbers are not needed.
  void skip_pair() { ++pair_; }

  /// Moves to the fixed block of dimensions of vertex `vertex` of the path, whatever was drawn
  /// before: what one vertex uses never shifts the numbers of the next.
  void start_vertex(uint32_t vertex) { pair_ = (vertex + 1) * pairs_per_vertex; }

  /// The sampler of branch `index` out of several at this point; branches of the same use and
  /// `number` (below its row's count), and of the same parent, stratify one another.
  Sampler split(Split use, uint32_t index, uint32_t number = 0) const {
    const uint64_t key = key_of(row_of(use), number);
    return {hash_mix(hash_mix(scramble_, (uint64_t(index_) << 32) | pair_), ~key), index};
  }

  /// More dimensions for the same index, one set for each use and `number` (below its row's count):
  /// for quantities whose number is not known beforehand. Over consecutive indices they are as well
  /// stratified as those of the parent.
  Sampler fork(Fork use, uint32_t number = 0) const {
    const uint64_t key = key_of(row_of(use), number);
    return {hash_mix(hash_mix(scramble_, pair_), key | 0x100000000ull), index_};
  }

  /// The i-th of `count` samples at this point, where every index of the parent takes as many: all
  /// of them stratify one another, over consecutive indices too.
  Sampler one_of(Series use, uint32_t count, uint32_t i) const {
    const uint64_t key = key_of(row_of(use), 0) << 34 | 0x200000000ull;
    return {hash_mix(hash_mix(scramble_, pair_), key | count), index_ * count + i};
  }

  static constexpr uint32_t pairs_per_vertex = 8;
  static constexpr uint32_t stratified_pairs = 4 * pairs_per_vertex;

 private:
  template <typename Row>
  static uint64_t key_of(const Row& row, uint32_t number) {
    assert(number < row.count);
    return row.first + number;
  }

  uint64_t scramble_;
  uint32_t index_, reversed_index_;
  uint32_t pair_ = 0;
};

inline Vec2f Sampler::next_independent_2d() {
  using namespace sampler_details;
  const uint64_t r = hash_mix(hash_mix(scramble_, pair_++), index_);
  return {to_unit(uint32_t(r)), to_unit(uint32_t(r >> 32))};
}

inline Vec2f Sampler::next_2d() {
  using namespace sampler_details;
  if (pair_ >= stratified_pairs) return next_independent_2d();
  const uint64_t h = hash_mix(scramble_, pair_++);
  // The shuffle of the index is itself an Owen scramble, so any run of 2^k indices stays a net.
  const uint32_t reversed = owen_hash_reversed(reversed_index_, uint32_t(h));
  const uint64_t seeds = h * 0xd1342543de82ef95ull + 1;
  // The first Sobol dimension is the bit reversal of the index: reversed once more, the index.
  const Words sobol_reversed{reverse_bits(reversed), sobol_second_reversed(reversed), 0, 0};
  const Words seeds_of_both{uint32_t(h >> 32), uint32_t(seeds >> 32), 0, 0};
  const Words both = reverse_bits(owen_hash_reversed(sobol_reversed, seeds_of_both));
  return {to_unit(both[0]), to_unit(both[1])};
}

}  // namespace kaustik
