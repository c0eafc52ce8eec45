#pragma once
#include <bit>
#include <cstring>
#include <span>
#include <vector>

#include "kaustik/base/binary_file.h"
#include "kaustik/base/exact_sum.h"

namespace kaustik {

/// Writes exact sums without the bytes that say nothing, as docs/reference/checkpoint_file.md
/// describes it: most have 5 to 8 of their 16, zeros none.
void put_sums(BinaryWriter& writer, std::span<const Fixed> sums);

/// How many bytes that takes.
uint64_t packed_size(std::span<const Fixed> sums);

/// Reads so many; throws as BinaryReader does. Allocates at most 16 bytes for each of the file.
std::vector<Fixed> get_sums(BinaryReader& reader, uint64_t count);

/// Sums that were read and are still packed: lists of so many each.
class PackedSums {
 public:
  /// At least one in a list.
  explicit PackedSums(size_t per_list) : per_list_(per_list) {}
  /// Reads so many lists, which are there until the reader is asked again. Throws as get_sums().
  void read(BinaryReader& reader, size_t lists);
  /// Where a list begins, for take_sum(): each of its sums is valid.
  const uint8_t* list(size_t index) const { return bytes_ + begins_[index]; }

 private:
  /// Finds where lists begin and end in these bytes, as many as there are whole; returns how many
  /// are known then, and leaves in `end` where the last one ends.
  size_t find_lists(std::span<const uint8_t> bytes, size_t known, const BinaryReader& reader);

  size_t per_list_;
  const uint8_t* bytes_ = nullptr;
  std::vector<size_t> begins_;   ///< of the lists, and the end of the last
  std::vector<uint8_t> padded_;  ///< a copy, where take_sum() would read beyond the bytes
};

/// A sum has a code, and at most so many bytes that follow it.
inline constexpr size_t most_packed = 1 + sizeof(Fixed);
/// The code of zero: as of all that has no byte, the last is before the first.
inline constexpr uint8_t packed_zero = 0x01;

namespace packed_details {

/// A number of bytes from the lowest to the highest.
template <typename Unsigned>
Unsigned number_at(const uint8_t* bytes) {
  Unsigned number = 0;
  if constexpr (std::endian::native == std::endian::little)
    std::memcpy(&number, bytes, sizeof number);
  else
    for (size_t i = sizeof number; i-- > 0;) number = Unsigned(number << 8) | bytes[i];
  return number;
}

}  // namespace packed_details

/// The sum that begins there, which is valid; goes on to the one behind it. May read
/// `most_packed` bytes, whether the sum has them or not.
inline Fixed take_sum(const uint8_t*& packed) {
  using packed_details::number_at;
  const int first = *packed & 15, bytes = (*packed >> 4) - first + 1;
  // Bytes that are not its own leave at the top, and the sign comes in from there. By halves, since
  // no shift takes all bits at once.
  UnsignedFixed number;
  if (bytes <= int(sizeof(uint64_t))) {
    const int half = 4 * (int(sizeof(uint64_t)) - bytes);
    const auto own = int64_t(number_at<uint64_t>(packed + 1) << half << half);
    number = UnsignedFixed(Fixed(own >> half >> half));
  } else {
    const int foreign = 8 * (int(sizeof(Fixed)) - bytes);
    number = UnsignedFixed(Fixed(number_at<UnsignedFixed>(packed + 1) << foreign) >> foreign);
  }
  packed += 1 + bytes;
  return Fixed(number << (8 * first));
}

}  // namespace kaustik
