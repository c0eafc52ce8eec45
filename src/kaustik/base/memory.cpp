#include "kaustik/base/memory.h"

#include <sys/mman.h>
#include <unistd.h>

namespace kaustik {

int64_t physical_memory_bytes() {
  const int64_t pages = ::sysconf(_SC_PHYS_PAGES);
  const int64_t page_size = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page_size > 0 ? pages * page_size : INT64_MAX;
}

void prefer_large_pages(void* begin, size_t bytes) {
  constexpr size_t least_bytes = size_t{4} << 20;
  if (bytes < least_bytes) return;
  // Of whole pages; what the system makes of it changes no results.
  const auto page_size = uintptr_t(::sysconf(_SC_PAGESIZE));
  const uintptr_t first = (uintptr_t(begin) + page_size - 1) / page_size * page_size;
  const uintptr_t last = (uintptr_t(begin) + bytes) / page_size * page_size;
  ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

void* allocate_large(size_t bytes) {
  void* const begin =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (begin == MAP_FAILED) throw std::bad_alloc();
  prefer_large_pages(begin, bytes);
  return begin;
}

void free_large(void* begin, size_t bytes) noexcept { ::munmap(begin, bytes); }

}  // namespace kaustik
