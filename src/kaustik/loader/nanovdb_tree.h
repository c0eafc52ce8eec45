#pragma once
// A grid of a file of NanoVDB, unpacked.

#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "kaustik/base/error.h"
#include "kaustik/loader/nanovdb_file.h"

namespace kaustik {

/// Bytes of which nothing is believed. What reads beyond them throws Error(input).
class NanoVdbBytes {
 public:
  NanoVdbBytes(std::span<const uint8_t> bytes, const Place& place) : bytes_(bytes), place_(place) {}

  uint64_t size() const { return bytes_.size(); }
  const Place& place() const { return place_; }
  std::span<const uint8_t> part(uint64_t begin, uint64_t count) const {
    if (begin > size() || count > size() - begin) damaged("it is truncated");
    return bytes_.subspan(size_t(begin), size_t(count));
  }
  template <typename T>
  T at(uint64_t begin) const {
    T value;
    std::memcpy(&value, part(begin, sizeof(T)).data(), sizeof(T));
    return value;
  }
  [[noreturn]] void damaged(const std::string& why) const {
    throw Error(ErrorKind::input, "the NanoVDB file is damaged: " + why, "copy or write it again",
                place_);
  }
  [[noreturn]] void refuse(const std::string& why, const std::string& remedy) const {
    throw Error(ErrorKind::input, why, remedy, place_);
  }

 private:
  std::span<const uint8_t> bytes_;
  const Place& place_;
};

/// What the tree of a grid holds, as read_nanovdb() has it.
DenseGrid dense_grid_of(const NanoVdbBytes& grid, size_t most_samples);

}  // namespace kaustik
