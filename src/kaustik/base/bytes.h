#pragma once
// Numbers one after the other in memory, in the byte order of the machine.

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace kaustik {

/// The bytes of items, as they lie in memory.
template <typename Item>
std::span<const uint8_t> bytes_in(std::span<const Item> items) {
  static_assert(std::is_trivially_copyable_v<Item>);
  return {reinterpret_cast<const uint8_t*>(items.data()), items.size_bytes()};
}

/// Collects numbers.
class ByteWriter {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes(&value, sizeof(T));
  }
  /// The number of items and all of them.
  template <typename T>
  void put_array(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(uint64_t(values.size()));
    put_bytes(values.data(), values.size() * sizeof(T));
  }
  void put_bytes(const void* data, size_t size);
  void put_text(const std::string& text);

  const std::vector<uint8_t>& bytes() const { return bytes_; }
  std::vector<uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<uint8_t> bytes_;
};

/// Reads them again. Whatever is wrong is an Error(input) that names `what`. Nothing is allocated
/// but in proportion to the bytes that are there.
class ByteReader {
 public:
  /// The bytes must outlive this.
  ByteReader(std::span<const uint8_t> bytes, std::string what)
      : rest_(bytes), what_(std::move(what)) {}
  template <typename T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(static_cast<void*>(&value), get_bytes(sizeof(T)).data(), sizeof(T));
    return value;
  }
  /// As put_array() wrote it.
  template <typename T>
  std::vector<T> get_array() {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto count = get<uint64_t>();
    if (count > rest_.size() / sizeof(T)) damaged("a count in it is larger than it is");
    std::vector<T> values(count);
    const std::span<const uint8_t> bytes = get_bytes(count * sizeof(T));
    if (count > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    return values;
  }
  /// The same of exactly so many items.
  template <typename T>
  std::vector<T> get_array(size_t expected) {
    std::vector<T> values = get_array<T>();
    if (values.size() != expected) damaged("it holds another number of items than is expected");
    return values;
  }
  std::span<const uint8_t> get_bytes(uint64_t count);
  std::string get_text();
  bool get_flag();
  /// Throws unless everything has been read.
  void expect_end() const;
  [[noreturn]] void damaged(const std::string& why) const;

 private:
  std::span<const uint8_t> rest_;
  std::string what_;
};

}  // namespace kaustik
