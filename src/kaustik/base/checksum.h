#pragma once
#include <cstdint>
#include <cstring>
#include <span>

namespace kaustik {

/// checksum() of bytes that come piece by piece.
class RunningChecksum {
 public:
  /// Of so many bytes in all.
  explicit RunningChecksum(uint64_t size) : sum_(size) {}
  /// The next of them; a number that 8 divides unless these are the last.
  void add(std::span<const uint8_t> bytes) {
    for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
      uint64_t word;
      std::memcpy(&word, bytes.data(), 8);
      sum_ = (sum_ ^ word) * factor;
      sum_ ^= sum_ >> 32;
    }
    for (const uint8_t byte : bytes) sum_ = (sum_ ^ byte) * factor;
  }
  uint64_t value() const { return sum_ ^ (sum_ >> 32); }

 private:
  static constexpr uint64_t factor = 0x9e3779b97f4a7c15ull;
  uint64_t sum_;
};

/// Of bytes that may have been damaged; changes with every byte: each step is a bijection of both
/// its arguments. No protection against those who want to deceive.
inline uint64_t checksum(std::span<const uint8_t> bytes) {
  RunningChecksum sum(bytes.size());
  sum.add(bytes);
  return sum.value();
}

}  // namespace kaustik
