#include "kaustik/value.h"

#include <cstring>

#include "kaustik/base/parameters.h"
#include "kaustik/base/transform.h"
#include "kaustik/library/access.h"
#include "kaustik/library/boundary.h"

namespace kaustik::v0 {
namespace {

using details::Access;

Vec3d internal(const Vec3& v) { return {v.x, v.y, v.z}; }

Transform shown(const kaustik::Transform& transform) {
  Transform result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      result.matrix[size_t(4 * row + column)] = transform.at(row, column);
  return result;
}

kaustik::Transform internal(const Transform& transform) {
  double rows[4][4];
  for (size_t i = 0; i < 16; ++i) rows[i / 4][i % 4] = transform.matrix[i];
  return kaustik::Transform(rows);
}

std::vector<size_t> extents_of(size_t rows, size_t columns) {
  return columns == 1 ? std::vector{rows} : std::vector{rows, columns};
}

/// Throws Error for sizes that no memory has, and for rows that lie nowhere.
size_t checked_count(const void* data, size_t rows, size_t columns, size_t element) {
  if (columns == 0) throw wrong_input("an array has no columns", "give it at least one");
  if (rows > SIZE_MAX / 2 / element / columns)
    throw wrong_input("an array has more numbers than memory can hold",
                      "check its rows and columns");
  if (rows > 0 && data == nullptr)
    throw wrong_input("an array has rows, but its pointer is null", "give it their address");
  return rows * columns;
}

}  // namespace

Transform Transform::translate(const Vec3& offset) {
  return guarded([&] { return shown(kaustik::Transform::translate(internal(offset))); });
}
Transform Transform::scale(const Vec3& factors) {
  return guarded([&] { return shown(kaustik::Transform::scale(internal(factors))); });
}
Transform Transform::rotate(const Vec3& axis, double degrees) {
  return guarded([&] { return shown(kaustik::Transform::rotate(internal(axis), degrees)); });
}
Transform Transform::look_at(const Vec3& origin, const Vec3& target, const Vec3& up) {
  return guarded([&] {
    return shown(kaustik::Transform::look_at(internal(origin), internal(target), internal(up)));
  });
}
Transform operator*(const Transform& a, const Transform& b) {
  return guarded([&] { return shown(internal(a) * internal(b)); });
}

Array::Array(std::shared_ptr<const details::ArrayState> state) : state_(std::move(state)) {}

template <typename T>
Array Array::copy(const T* data, size_t rows, size_t columns, ptrdiff_t stride_bytes) {
  return guarded([&] {
    std::vector<T> values(checked_count(data, rows, columns, sizeof(T)));
    const ptrdiff_t stride = stride_bytes != 0 ? stride_bytes : ptrdiff_t(columns * sizeof(T));
    const char* row = reinterpret_cast<const char*>(data);
    for (size_t i = 0; i < rows; ++i, row += stride)
      std::memcpy(values.data() + i * columns, row, columns * sizeof(T));
    return Array(std::make_shared<const details::ArrayState>(
        details::ArrayState{kaustik::Array::of(extents_of(rows, columns), std::move(values))}));
  });
}

template <typename T>
Array Array::borrow(const T* data, size_t rows, size_t columns, std::shared_ptr<const void> owner) {
  return guarded([&] {
    const std::span values(data, checked_count(data, rows, columns, sizeof(T)));
    return Array(std::make_shared<const details::ArrayState>(
        details::ArrayState{kaustik::Array::borrow(element_type_of<T>(), extents_of(rows, columns),
                                                   std::as_bytes(values), std::move(owner))}));
  });
}

#define KAUSTIK_ARRAY_OF(T)                                                          \
  template KAUSTIK_EXPORT Array Array::copy<T>(const T*, size_t, size_t, ptrdiff_t); \
  template KAUSTIK_EXPORT Array Array::borrow<T>(const T*, size_t, size_t,           \
                                                 std::shared_ptr<const void>);
KAUSTIK_ARRAY_OF(uint8_t)
KAUSTIK_ARRAY_OF(uint16_t)
KAUSTIK_ARRAY_OF(uint32_t)
KAUSTIK_ARRAY_OF(int32_t)
KAUSTIK_ARRAY_OF(int64_t)
KAUSTIK_ARRAY_OF(float)
KAUSTIK_ARRAY_OF(double)
#undef KAUSTIK_ARRAY_OF

Array Array::shaped(std::vector<size_t> extents) const {
  return guarded([&] {
    const kaustik::Array& array = *state_->array;
    return Array(std::make_shared<const details::ArrayState>(details::ArrayState{
        kaustik::Array::borrow(array.type(), std::move(extents), array.bytes(), state_->array)}));
  });
}

size_t Array::count() const noexcept { return state_->array->count(); }

Value::Value(std::shared_ptr<const details::ValueState> state) : state_(std::move(state)) {}
Value Value::of_boolean(bool value) { return Access::made(value); }
Value Value::of_integer(int64_t value, bool is_positive) {
  if (is_positive && value < 0)
    throw wrong_input("a whole number is over 9223372036854775807", "give a smaller one");
  return Access::made(value);
}
Value::Value(double value) : Value(Access::made(value)) {}
Value::Value(const char* text)
    : Value(text ? std::string(text)
                 : throw wrong_input("a text is a null pointer", "give it a text")) {}
Value::Value(std::string text) : Value(Access::made(std::move(text))) {}
Value::Value(const Vec3& value) : Value(Access::made(internal(value))) {}
Value::Value(const Rgb& value) : Value(Access::made(kaustik::Rgb{value.r, value.g, value.b})) {}
Value::Value(Spectrum value) : Value(Access::made(SpectralCurve{std::move(value.samples)})) {}
Value::Value(const Transform& value)
    : Value(guarded([&] { return Access::made(internal(value)); })) {}
Value::Value(Array value) : Value(Access::made(Access::array(value))) {}
Value Value::from_text(std::string text) { return Access::made(Untyped{std::move(text)}); }

}  // namespace kaustik::v0
