#pragma once
#include <cstdint>
#include <cstring>
#include <span>

namespace kaustik {

/// Of bytes that may have been damaged; changes with every byte: each step is a bijection of both
/// its arguments. No protection against those who want to deceive.
inline uint64_t checksum(std::span<const uint8_t> bytes) {
  uint64_t sum = bytes.size();
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    uint64_t word;
    std::memcpy(&word, bytes.data(), 8);
    sum = (sum ^ word) * 0x9e3779b97f4a7c15ull;
    sum ^= sum >> 32;
  }
  for (const uint8_t byte : bytes) sum = (sum ^ byte) * 0x9e3779b97f4a7c15ull;
  return sum ^ (sum >> 32);
}

}  // namespace kaustik
