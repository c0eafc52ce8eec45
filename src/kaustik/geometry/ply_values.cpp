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

/// Where the length is a byte, and the numbers are what they become.
bool copy_plain_corners(const PlyRecords& records, size_t length_offset, uint64_t vertices,
                        std::array<uint32_t, 3>* to) {
  const uint8_t* from = records.bytes.data() + length_offset;
  uint32_t largest[3] = {0, 0, 0};
  uint8_t differences = 0;
  for (size_t i = 0; i < records.size(); ++i, from += records.record_bytes) {
    std::array<uint32_t, 3>& corners = to[i];
    differences |= *from ^ uint8_t(3);
    std::memcpy(corners.data(), from + 1, sizeof(corners));
    for (size_t k = 0; k < 3; ++k) largest[k] = std::max(largest[k], corners[k]);
  }
  return differences == 0 && std::max({largest[0], largest[1], largest[2]}) < vertices;
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
