#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace kaustik {

/// Of this machine; the largest number there is where the system does not tell.
int64_t physical_memory_bytes();

/// Asks the system for large pages where they pay: the first write to memory then takes a fraction
/// of the time. For memory that nothing has been written to; where there are no large pages, and of
/// less than some megabytes, nothing changes.
void prefer_large_pages(void* begin, size_t bytes);

/// Memory of the system's own, for what is large: in large pages, and given back at once when it is
/// freed. Throws std::bad_alloc.
void* allocate_large(size_t bytes);
void free_large(void* begin, size_t bytes) noexcept;

/// An allocator whose vectors leave the numbers that resize() adds as they are, so that who fills
/// them, in parallel, is the first to touch their memory.
template <typename T>
struct UnsetAllocator {
  using value_type = T;
  UnsetAllocator() = default;
  template <typename U>
  UnsetAllocator(const UnsetAllocator<U>&) noexcept {}
  friend bool operator==(const UnsetAllocator&, const UnsetAllocator&) = default;

  T* allocate(size_t count) {
    if (count < large_bytes / sizeof(T)) return std::allocator<T>().allocate(count);
    if (count > SIZE_MAX / 2 / sizeof(T)) throw std::bad_alloc();
    return static_cast<T*>(allocate_large(count * sizeof(T)));
  }
  void deallocate(T* begin, size_t count) noexcept {
    if (count < large_bytes / sizeof(T))
      std::allocator<T>().deallocate(begin, count);
    else
      free_large(begin, count * sizeof(T));
  }
  template <typename U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

 private:
  static constexpr size_t large_bytes = size_t{4} << 20;
};
template <typename T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

/// Room for `count` items of a vector that has none, in large pages.
template <typename T>
void reserve_large(std::vector<T>& items, size_t count) {
  items.reserve(count);
  prefer_large_pages(items.data(), items.capacity() * sizeof(T));
}
template <typename T>
void reserve_large(UnsetVector<T>& items, size_t count) {
  items.reserve(count);
}

}  // namespace kaustik
