#pragma once
// Buffers of numbers in a scene's description: vertices, faces, pixels. Plain data.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace kaustik {

enum class ElementType : uint8_t { uint8, uint16, uint32, int32, int64, float32, float64 };

/// "uint8", "float32", …
const char* element_name(ElementType type);
size_t element_size(ElementType type);

template <typename T>
constexpr ElementType element_type_of() {
  if constexpr (std::is_same_v<T, uint8_t>) return ElementType::uint8;
  if constexpr (std::is_same_v<T, uint16_t>) return ElementType::uint16;
  if constexpr (std::is_same_v<T, uint32_t>) return ElementType::uint32;
  if constexpr (std::is_same_v<T, int32_t>) return ElementType::int32;
  if constexpr (std::is_same_v<T, int64_t>) return ElementType::int64;
  if constexpr (std::is_same_v<T, float>) return ElementType::float32;
  if constexpr (std::is_same_v<T, double>) return ElementType::float64;
}

/// Numbers of one type in rows and columns, the last index running fastest, without gaps and in
/// the byte order of the machine. Immutable and shared by all threads; the memory may be somebody
/// else's.
class Array {
 public:
  /// Memory that `owner` keeps alive and nobody changes as long as the array lives. Throws
  /// Error(input) if the extents are not those of `bytes`, or the memory is not aligned for its
  /// type.
  static std::shared_ptr<const Array> borrow(ElementType type, std::vector<size_t> extents,
                                             std::span<const std::byte> bytes,
                                             std::shared_ptr<const void> owner);
  /// Throws Error(input) if the extents are not those of `values`.
  template <typename T>
  static std::shared_ptr<const Array> of(std::vector<size_t> extents, std::vector<T> values) {
    const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
    return borrow(element_type_of<T>(), std::move(extents), std::as_bytes(std::span(*owner)),
                  owner);
  }

  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;

  ElementType type() const { return type_; }
  /// Such as {rows, columns}; none: a single number.
  const std::vector<size_t>& extents() const { return extents_; }
  size_t count() const { return bytes_.size() / element_size(type_); }
  std::span<const std::byte> bytes() const { return bytes_; }

  /// Calls `use` with all numbers, as a span of their type.
  template <typename Use>
  decltype(auto) visit(const Use& use) const {
    switch (type_) {
      case ElementType::uint8:
        return use(values<uint8_t>());
      case ElementType::uint16:
        return use(values<uint16_t>());
      case ElementType::uint32:
        return use(values<uint32_t>());
      case ElementType::int32:
        return use(values<int32_t>());
      case ElementType::int64:
        return use(values<int64_t>());
      case ElementType::float32:
        return use(values<float>());
      case ElementType::float64:
        break;
    }
    return use(values<double>());
  }

  /// Of type, extents and all bytes: alike for equal arrays, in all likelihood not for others.
  /// Found out when it is first asked for.
  uint64_t digest() const;

 private:
  Array(ElementType type, std::vector<size_t> extents, std::span<const std::byte> bytes,
        std::shared_ptr<const void> owner);
  template <typename T>
  std::span<const T> values() const {
    return {reinterpret_cast<const T*>(bytes_.data()), count()};
  }

  ElementType type_;
  std::vector<size_t> extents_;
  std::span<const std::byte> bytes_;
  std::shared_ptr<const void> owner_;
  mutable std::once_flag digest_once_;
  mutable uint64_t digest_ = 0;
};

bool is_integer(ElementType type);

/// "[4, 3]".
std::string extents_text(std::span<const size_t> extents);

}  // namespace kaustik
