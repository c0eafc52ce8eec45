#include "kaustik/render/packed_sums.h"

#include <algorithm>
#include <array>
#include <bit>

namespace kaustik {
namespace {

constexpr int byte_count = sizeof(Fixed);
constexpr uint8_t code_of_zero = 0x01;

/// Of bytes from the lowest to the highest.
UnsignedFixed number_of(const uint8_t* bytes) {
  std::array<uint8_t, byte_count> in_order;
  std::copy_n(bytes, byte_count, in_order.begin());
  if constexpr (std::endian::native == std::endian::big)
    std::reverse(in_order.begin(), in_order.end());
  return std::bit_cast<UnsignedFixed>(in_order);
}

uint8_t byte_of(Fixed value, int index) { return uint8_t(value >> (8 * index)); }
/// What all bytes behind `last` must be for the sign to come out right.
uint8_t sign_byte(Fixed value) { return value < 0 ? 0xff : 0; }

int first_kept(Fixed value) {
  int first = 0;
  while (byte_of(value, first) == 0) ++first;
  return first;
}

int last_kept(Fixed value) {
  int last = byte_count - 1;
  const uint8_t sign = sign_byte(value);
  // A byte can go if the top bit of the one before it still tells the sign.
  while (last > 0 && byte_of(value, last) == sign && (byte_of(value, last - 1) ^ sign) < 0x80)
    --last;
  return last;
}

void put_sum(BinaryWriter& writer, Fixed value) {
  if (value == 0) return writer.put(code_of_zero);
  const int first = first_kept(value), last = last_kept(value);
  std::array<uint8_t, 1 + byte_count> bytes;
  bytes[0] = uint8_t(first | last << 4);
  for (int i = first; i <= last; ++i) bytes[size_t(1 + i - first)] = byte_of(value, i);
  writer.put_bytes(bytes.data(), size_t(2 + last - first));
}

/// Of a code and what follows it.
constexpr size_t most_packed = 1 + byte_count;

struct UnpackedSum {
  Fixed value = 0;
  size_t bytes = 1;  ///< that it took; 0: they are no sum
};

/// Reads `most_packed` bytes, whether the sum takes them or not.
UnpackedSum unpacked_sum(const uint8_t* packed) {
  const uint8_t code = packed[0];
  if (code == code_of_zero) return {};
  const int first = code & 15, last = code >> 4;
  if (first > last) return {0, 0};
  // Bytes that are not its own leave at the top, and the sign comes in from there.
  const int foreign_bits = 8 * (byte_count - 1 - (last - first));
  const auto value = Fixed(number_of(packed + 1) << foreign_bits) >> foreign_bits;
  const UnsignedFixed in_place = UnsignedFixed(value) << (8 * first);
  // The one number that has no opposite.
  if (in_place == UnsignedFixed(1) << 127) return {0, 0};
  return {Fixed(in_place), size_t(2 + last - first)};
}

/// As many as whole ones are surely among the bytes.
struct UnpackedSums {
  size_t count = 0, bytes = 0;
  bool are_valid = true;
};

UnpackedSums unpack_sums(std::span<const uint8_t> packed, std::span<Fixed> sums) {
  UnpackedSums result;
  while (result.count < sums.size() && result.bytes + most_packed <= packed.size()) {
    const UnpackedSum sum = unpacked_sum(packed.data() + result.bytes);
    if (sum.bytes == 0) return {0, 0, false};
    sums[result.count++] = sum.value;
    result.bytes += sum.bytes;
  }
  return result;
}

/// Of bytes that are too few for unpack_sums().
UnpackedSums unpack_last_sum(std::span<const uint8_t> packed, Fixed& sum) {
  std::array<uint8_t, most_packed> padded{};
  std::copy(packed.begin(), packed.end(), padded.begin());
  const UnpackedSum last = unpacked_sum(padded.data());
  sum = last.value;
  return {1, last.bytes, last.bytes > 0 && last.bytes <= packed.size()};
}

}  // namespace

uint64_t packed_size(std::span<const Fixed> sums) {
  uint64_t size = 0;
  for (const Fixed sum : sums)
    size += sum == 0 ? 1 : uint64_t(2 + last_kept(sum) - first_kept(sum));
  return size;
}

void put_sums(BinaryWriter& writer, std::span<const Fixed> sums) {
  for (const Fixed sum : sums) put_sum(writer, sum);
}

std::vector<Fixed> get_sums(BinaryReader& reader, uint64_t count) {
  reader.need(count, 1);
  std::vector<Fixed> sums(count);
  for (std::span<Fixed> rest = sums; !rest.empty();) {
    const std::span<const uint8_t> packed = reader.bytes_ahead(most_packed);
    const UnpackedSums unpacked = packed.size() < most_packed
                                      ? unpack_last_sum(packed, rest.front())
                                      : unpack_sums(packed, rest);
    if (!unpacked.are_valid) reader.damaged("a sum in it is not valid");
    reader.skip(unpacked.bytes);
    rest = rest.subspan(unpacked.count);
  }
  return sums;
}

}  // namespace kaustik
