#pragma once
// Numbers as PLY files hold them, one by one and many at once; for the reader alone.

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "kaustik/geometry/mesh_checks.h"
#include "kaustik/geometry/shape.h"

namespace kaustik {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// In bytes.
size_t size_of(PlyType type);
/// None has that name.
std::optional<PlyType> ply_type_named(std::string_view name);
/// The number that an integer of this type stands for 1 with; 0: it is none.
double largest_of(PlyType type);
/// The number of a type that begins at `bytes`.
double value_at(const uint8_t* bytes, PlyType type, bool big_endian);

/// Bytes of records of one size, one after the other.
struct PlyRecords {
  std::span<const uint8_t> bytes;
  size_t record_bytes = 1;
  bool big_endian = false;

  size_t size() const { return bytes.size() / record_bytes; }
  const uint8_t* operator[](size_t i) const { return bytes.data() + i * record_bytes; }
};

/// A number of each record, by where it begins.
struct PlyField {
  size_t offset = 0;
  PlyType type = PlyType::float32;
};

/// Copies `width` floats, 2 or 3, that begin at `first` bytes of each record and are what they
/// become. False, with all of them copied: one is not finite.
bool copy_plain_vectors(const PlyRecords& records, size_t first, size_t width, void* to);

/// Copies a vector of each record, whose numbers are `fields`. False, with all of them copied: one
/// is not finite.
template <typename Vector, size_t count>
bool copy_vectors(const PlyRecords& records, const std::array<PlyField, count>& fields,
                  Vector* to) {
  static_assert(sizeof(Vector) == count * sizeof(float));
  // Mostly they are what they become.
  bool as_it_is = !records.big_endian;
  for (size_t k = 0; k < count; ++k)
    as_it_is = as_it_is && fields[k].type == PlyType::float32 &&
               fields[k].offset == fields[0].offset + k * sizeof(float);
  const size_t size = records.size();
  if (as_it_is) return copy_plain_vectors(records, fields[0].offset, count, to);
  for (size_t i = 0; i < size; ++i)
    for (size_t k = 0; k < count; ++k)
      to[i][int(k)] =
          float(value_at(records[i] + fields[k].offset, fields[k].type, records.big_endian));
  return are_finite(std::span<const Vector>(to, size));
}

/// Copies the corners of triangles, which are a list of three numbers of each record. False, with
/// some of them copied: a list has another length, or refers to one of `vertices` that is not.
bool copy_corners(const PlyRecords& records, const PlyField& length, PlyType index,
                  uint64_t vertices, std::array<uint32_t, 3>* to);

}  // namespace kaustik
