#include "kaustik/render/packed_sums.h"

#include <array>

namespace kaustik {
namespace {

constexpr int byte_count = sizeof(Fixed);
/// The code of zero: as of all that has no byte, the last is before the first.
constexpr uint8_t packed_zero = 0x01;

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
  if (value == 0) return writer.put(packed_zero);
  const int first = first_kept(value), last = last_kept(value);
  std::array<uint8_t, 1 + byte_count> bytes;
  bytes[0] = uint8_t(first | last << 4);
  for (int i = first; i <= last; ++i) bytes[size_t(1 + i - first)] = byte_of(value, i);
  writer.put_bytes(bytes.data(), size_t(2 + last - first));
}

Fixed get_sum(BinaryReader& reader) {
  const auto code = reader.get<uint8_t>();
  if (code == packed_zero) return 0;
  const int first = code & 15, last = code >> 4;
  if (first > last) reader.damaged("a sum in it is not valid");
  const auto bytes = reader.get_bytes(size_t(last - first + 1));
  UnsignedFixed value = bytes.back() < 0x80 ? 0 : ~UnsignedFixed(0);
  for (size_t i = bytes.size(); i-- > 0;) value = value << 8 | bytes[i];
  const auto sum = Fixed(value << (8 * first));
  // The one number that has no opposite.
  if (sum == Fixed(UnsignedFixed(1) << 127)) reader.damaged("a sum in it is not valid");
  return sum;
}

}  // namespace

void put_sums(BinaryWriter& writer, std::span<const Fixed> sums) {
  for (const Fixed sum : sums) put_sum(writer, sum);
}

std::vector<Fixed> get_sums(BinaryReader& reader, uint64_t count) {
  reader.need(count, 1);
  std::vector<Fixed> sums(count);
  for (Fixed& sum : sums) sum = get_sum(reader);
  return sums;
}

}  // namespace kaustik
