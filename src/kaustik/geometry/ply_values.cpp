#include "kaustik/geometry/ply_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace kaustik {
namespace {

template <typename Number>
Number loaded(const uint8_t* bytes, bool big_endian) {
  std::array<uint8_t, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes, sizeof(Number));
  if (big_endian) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

/// Four numbers in one register.
using FourNumbers = uint32_t __attribute__((vector_size(16)));

/// Copies three numbers that begin at `first` bytes of each record. Returns `test` of all of them,
/// lane by lane, or-ed together; of the fourth lane it says nothing.
template <typename Test>
FourNumbers copy_threes(const PlyRecords& records, size_t first, void* to, const Test& test) {
  constexpr size_t three = 3 * sizeof(uint32_t);
  const size_t size = records.size();
  FourNumbers found{};
  if (size == 0) return found;
  const uint8_t* from = records.bytes.data() + first;
  auto* out = static_cast<uint8_t*>(to);
  // A fourth number is read and written with them, but not with the last ones: what lies behind
  // those is not ours.
  for (size_t i = 0; i + 1 < size; ++i, from += records.record_bytes, out += three) {
    FourNumbers lanes;
    std::memcpy(&lanes, from, sizeof(lanes));
    std::memcpy(out, &lanes, sizeof(lanes));
    found |= test(lanes);
  }
  FourNumbers last{};
  std::memcpy(&last, from, three);
  std::memcpy(out, &last, three);
  return found | test(last);
}

/// The sign bit of the result tells that the float with these bits is not finite.
template <typename Bits>
Bits signs_of_infinity(Bits bits, Bits one_exponent, Bits all_exponents) {
  return (bits & all_exponents) + one_exponent;
}
constexpr uint32_t exponent_one = 0x00800000, exponent_all = 0x7f800000, sign_bit = 0x80000000;

/// Where the length is a byte, and the numbers are what they become.
bool copy_plain_corners(const PlyRecords& records, size_t length_offset, uint64_t vertices,
                        std::array<uint32_t, 3>* to) {
  if (vertices == 0) return records.size() == 0;
  uint8_t differences = 0;
  const uint8_t* length = records.bytes.data() + length_offset;
  for (size_t i = 0; i < records.size(); ++i, length += records.record_bytes)
    differences |= *length ^ uint8_t(3);
  const auto last = uint32_t(std::min<uint64_t>(vertices - 1, UINT32_MAX));
  const FourNumbers lasts{last, last, last, last};
  const FourNumbers outside = copy_threes(records, length_offset + 1, to, [&](FourNumbers lanes) {
    return FourNumbers(lanes > lasts);
  });
  return differences == 0 && (outside[0] | outside[1] | outside[2]) == 0;
}

}  // namespace

size_t size_of(PlyType type) {
  constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[size_t(type)];
}

std::optional<PlyType> ply_type_named(std::string_view name) {
  constexpr std::pair<std::string_view, PlyType> names[] = {
      {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
      {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
      {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
      {"float64", PlyType::float64}};
  for (const auto& [text, type] : names)
    if (text == name) return type;
  return std::nullopt;
}

double largest_of(PlyType type) {
  constexpr double largest[] = {0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, 0, 0};
  return largest[size_t(type)];
}

double value_at(const uint8_t* bytes, PlyType type, bool big_endian) {
  switch (type) {
    case PlyType::int8:
      return loaded<int8_t>(bytes, big_endian);
    case PlyType::uint8:
      return loaded<uint8_t>(bytes, big_endian);
    case PlyType::int16:
      return loaded<int16_t>(bytes, big_endian);
    case PlyType::uint16:
      return loaded<uint16_t>(bytes, big_endian);
    case PlyType::int32:
      return loaded<int32_t>(bytes, big_endian);
    case PlyType::uint32:
      return loaded<uint32_t>(bytes, big_endian);
    case PlyType::float32:
      return double(loaded<float>(bytes, big_endian));
    case PlyType::float64:
      return loaded<double>(bytes, big_endian);
  }
  return 0;
}

bool copy_plain_vectors(const PlyRecords& records, size_t first, size_t width, void* to) {
  if (width == 3) {
    const FourNumbers one{exponent_one, exponent_one, exponent_one, exponent_one};
    const FourNumbers all{exponent_all, exponent_all, exponent_all, exponent_all};
    const FourNumbers found = copy_threes(
        records, first, to, [&](FourNumbers lanes) { return signs_of_infinity(lanes, one, all); });
    return ((found[0] | found[1] | found[2]) & sign_bit) == 0;
  }
  const auto twice = [](uint32_t bits) { return uint64_t(bits) << 32 | bits; };
  const uint8_t* from = records.bytes.data() + first;
  auto* out = static_cast<uint8_t*>(to);
  uint64_t found = 0;
  for (size_t i = 0; i < records.size(); ++i, from += records.record_bytes, out += 8) {
    uint64_t two;
    std::memcpy(&two, from, sizeof(two));
    std::memcpy(out, &two, sizeof(two));
    found |= signs_of_infinity(two, twice(exponent_one), twice(exponent_all));
  }
  return (found & twice(sign_bit)) == 0;
}

bool copy_corners(const PlyRecords& records, const PlyField& length, PlyType index,
                  uint64_t vertices, std::array<uint32_t, 3>* to) {
  if (!records.big_endian && size_of(length.type) == 1 &&
      (index == PlyType::int32 || index == PlyType::uint32))
    return copy_plain_corners(records, length.offset, vertices, to);
  for (size_t i = 0; i < records.size(); ++i) {
    const uint8_t* from = records[i] + length.offset;
    if (value_at(from, length.type, records.big_endian) != 3) return false;
    from += size_of(length.type);
    for (uint32_t& corner : to[i]) {
      const double value = value_at(from, index, records.big_endian);
      if (!(value >= 0 && value < double(vertices) && value == std::floor(value))) return false;
      corner = uint32_t(value);
      from += size_of(index);
    }
  }
  return true;
}

}  // namespace kaustik
