#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <span>

namespace kaustik {

/// checksum() of bytes that come piece by piece.
class RunningChecksum {
 public:
  /// Of so many bytes in all.
  explicit RunningChecksum(uint64_t size) : lanes_{size, 1, 2, 3} {}
  /// The next of them; a number that `block` divides unless these are the last.
  void add(std::span<const uint8_t> bytes) {
    for (; bytes.size() >= block; bytes = bytes.subspan(block))
      for (size_t lane = 0; lane < lanes_.size(); ++lane)
        mix(lanes_[lane], word_at(bytes.data() + lane * sizeof(uint64_t)));
    for (const uint8_t byte : bytes) mix(lanes_[0], byte);
  }
  uint64_t value() const {
    uint64_t sum = lanes_[0];
    for (size_t lane = 1; lane < lanes_.size(); ++lane) mix(sum, lanes_[lane]);
    return sum;
  }
  /// Words of a block go to lanes of their own, so that none waits for the other.
  static constexpr size_t block = 4 * sizeof(uint64_t);

 private:
  static uint64_t word_at(const uint8_t* bytes) {
    uint64_t word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
  }
  static void mix(uint64_t& sum, uint64_t word) {
    sum = (sum ^ word) * 0x9e3779b97f4a7c15ull;
    sum ^= sum >> 32;
  }

  std::array<uint64_t, block / sizeof(uint64_t)> lanes_;
};

/// Of bytes that may have been damaged; changes with every byte: each step is a bijection of both
/// its arguments. No protection against those who want to deceive.
inline uint64_t checksum(std::span<const uint8_t> bytes) {
  RunningChecksum sum(bytes.size());
  sum.add(bytes);
  return sum.value();
}

}  // namespace kaustik
