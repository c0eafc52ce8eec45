#include "kaustik/render/packed_sums.h"

#include <algorithm>
#include <array>

namespace kaustik {
namespace {

constexpr int byte_count = sizeof(Fixed);

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
  std::array<uint8_t, most_packed> bytes;
  bytes[0] = uint8_t(first | last << 4);
  for (int i = first; i <= last; ++i) bytes[size_t(1 + i - first)] = byte_of(value, i);
  writer.put_bytes(bytes.data(), size_t(2 + last - first));
}

/// What a code tells: how many bytes a sum takes. Of one that is not valid that is anything.
int packed_bytes(uint8_t code) { return 2 + (code >> 4) - (code & 15); }

/// Codes that are not valid, or of sums that may not be.
constexpr std::array<bool, 256> doubtful_codes = [] {
  std::array<bool, 256> doubtful{};
  for (size_t code = 0; code < doubtful.size(); ++code) {
    const size_t first = code & 15, last = code >> 4;
    doubtful[code] = (first > last && code != packed_zero) || last == byte_count - 1;
  }
  return doubtful;
}();

/// Of one whose bytes are there.
bool is_valid(const uint8_t* packed) {
  const int first = *packed & 15, last = *packed >> 4;
  if (first > last) return *packed == packed_zero;
  // The one number that has no opposite.
  const auto* end = packed + 2 + (last - first);
  return last < byte_count - 1 || end[-1] != 0x80 ||
         std::any_of(packed + 1, end - 1, [](uint8_t byte) { return byte != 0; });
}

struct ListEnd {
  size_t end = 0;
  bool is_whole = false, is_valid = true;
};

/// Looks at every sum of a list before it believes it.
ListEnd careful_end(std::span<const uint8_t> bytes, size_t begin, size_t count) {
  size_t at = begin;
  for (; count > 0; --count) {
    if (at >= bytes.size()) return {at, false};
    const uint8_t code = bytes[at];
    if ((code & 15) > code >> 4 && code != packed_zero) return {at, true, false};
    const auto size = size_t(packed_bytes(code));
    if (size > bytes.size() - at) return {at, false};
    if (!is_valid(bytes.data() + at)) return {at, true, false};
    at += size;
  }
  return {at, true};
}

/// Of a list that does not leave `bytes`, whatever is in them.
ListEnd quick_end(std::span<const uint8_t> bytes, size_t begin, size_t count) {
  const uint8_t* at = bytes.data() + begin;
  bool is_doubtful = false;
  for (size_t i = 0; i < count; ++i) {
    const uint8_t code = *at;
    is_doubtful |= doubtful_codes[code];
    at += packed_bytes(code);
  }
  if (is_doubtful) return careful_end(bytes, begin, count);
  return {size_t(at - bytes.data()), true};
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

size_t PackedSums::find_lists(std::span<const uint8_t> bytes, size_t known,
                              const BinaryReader& reader) {
  // Not even sums that are all wrong lead farther away, either way.
  const size_t most = per_list_ * most_packed;
  for (; known + 1 < begins_.size(); ++known) {
    const size_t begin = begins_[known];
    const ListEnd list = begin >= most && bytes.size() - begin >= most
                             ? quick_end(bytes, begin, per_list_)
                             : careful_end(bytes, begin, per_list_);
    if (!list.is_valid) reader.damaged("a sum in it is not valid");
    if (!list.is_whole) break;
    begins_[known + 1] = list.end;
  }
  return known;
}

void PackedSums::read(BinaryReader& reader, size_t lists) {
  reader.need(lists, per_list_);
  // About as many bytes as last time: lists near one another are much alike.
  size_t wanted = std::max(lists * per_list_, begins_.empty() ? 0 : begins_.back());
  begins_.assign(lists + 1, 0);
  std::span<const uint8_t> bytes;
  for (size_t known = 0; known < lists; wanted = bytes.size() + bytes.size() / 8 + 1) {
    const size_t before = bytes.size();
    bytes = reader.bytes_ahead(wanted);
    if (bytes.size() == before) reader.damaged("a sum in it is not valid");
    known = find_lists(bytes, known, reader);
  }
  const size_t end = begins_.back();
  bytes_ = bytes.data();
  if (bytes.size() - end < most_packed) {
    padded_.assign(bytes.begin(), bytes.begin() + std::ptrdiff_t(end));
    padded_.resize(end + most_packed);
    bytes_ = padded_.data();
  }
  reader.skip(end);
}

std::vector<Fixed> get_sums(BinaryReader& reader, uint64_t count) {
  reader.need(count, 1);
  std::vector<Fixed> sums(count);
  if (count == 0) return sums;
  PackedSums packed(1);
  packed.read(reader, count);
  const uint8_t* at = packed.list(0);
  for (Fixed& sum : sums) sum = take_sum(at);
  return sums;
}

}  // namespace kaustik
