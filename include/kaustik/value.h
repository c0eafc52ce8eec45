#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/export.h"

namespace kaustik::v0 {

/// A point or a vector.
struct Vec3 {
  double x = 0, y = 0, z = 0;
};

/// Linear Rec. 709.
struct Rgb {
  double r = 0, g = 0, b = 0;
};

/// Pairs of wavelength (nm, ascending) and value, at least one; linear between.
struct Spectrum {
  std::vector<std::pair<double, double>> samples;
};

/// An affine map in the convention of column vectors: p' = M p.
struct KAUSTIK_EXPORT Transform {
  /// Row by row.
  std::array<double, 16> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  static Transform translate(const Vec3& offset);
  /// Throws Error if a factor is zero.
  static Transform scale(const Vec3& factors);
  /// Right-handed, about an axis of any length but zero, by degrees.
  static Transform rotate(const Vec3& axis, double degrees);
  /// Places a camera at `origin` so that it looks toward `target`. Throws Error if the three leave
  /// its directions open.
  static Transform look_at(const Vec3& origin, const Vec3& target, const Vec3& up);
};
/// First `b`, then `a`.
KAUSTIK_EXPORT Transform operator*(const Transform& a, const Transform& b);

namespace details {
struct Access;
struct ArrayState;
struct ValueState;
}  // namespace details

/// Rows of numbers of one type, as pictures and meshes are made of. Immutable; copies share the
/// numbers.
class KAUSTIK_EXPORT Array {
 public:
  Array(const Array&) = default;  // and nothing is moved: what one is taken from stays whole
  Array& operator=(const Array&) = default;
  /// Copies `rows` rows of `columns` numbers; from one row to the next are `stride_bytes` (0:
  /// packed, negative: backward). Element types: uint8_t, uint16_t, uint32_t, int32_t, int64_t,
  /// float, double. Throws Error for a null pointer to rows.
  template <typename T>
  static Array copy(const T* data, size_t rows, size_t columns, ptrdiff_t stride_bytes = 0);
  template <typename T>
  static Array copy(std::span<const T> values, size_t columns = 1) {
    return copy(values.data(), columns ? values.size() / columns : 0, columns);
  }
  /// The numbers where they lie, packed: `owner` keeps them alive, and nobody changes them as long
  /// as any scene has them. Throws Error for a null pointer, or one that is not aligned.
  template <typename T>
  static Array borrow(const T* data, size_t rows, size_t columns,
                      std::shared_ptr<const void> owner);

  /// The same numbers as a grid of rows, columns and channels and the like. Throws Error if that
  /// has another number of them.
  Array shaped(std::vector<size_t> extents) const;
  size_t count() const noexcept;

 private:
  friend struct details::Access;
  explicit Array(std::shared_ptr<const details::ArrayState> state);
  std::shared_ptr<const details::ArrayState> state_;
};

/// The value of a parameter. Its type has to be that of the parameter in docs/reference; a
/// whole number does for a number.
class KAUSTIK_EXPORT Value {
 public:
  Value(const Value&) = default;  // and nothing is moved
  Value& operator=(const Value&) = default;
  Value(std::same_as<bool> auto value) : Value(of_boolean(value)) {}
  Value(double value);
  template <std::integral T>
  requires(!std::same_as<T, bool>) Value(T value)
      : Value(of_integer(int64_t(value), value > T(0))) {}
  Value(const char* text);
  Value(std::string text);
  Value(const Vec3& value);
  Value(const Rgb& value);
  Value(Spectrum value);
  Value(const Transform& value);
  Value(Array value);
  /// Text that is read as the parameter's type asks, as `kaustik render --set` does.
  static Value from_text(std::string text);

 private:
  friend struct details::Access;
  static Value of_boolean(bool value);
  /// Throws Error where a positive number has become another.
  static Value of_integer(int64_t value, bool is_positive);
  explicit Value(std::shared_ptr<const details::ValueState> state);
  std::shared_ptr<const details::ValueState> state_;
};

}  // namespace kaustik::v0
