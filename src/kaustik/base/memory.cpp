#include "kaustik/base/memory.h"

#include <unistd.h>

namespace kaustik {

int64_t physical_memory_bytes() {
  const int64_t pages = ::sysconf(_SC_PHYS_PAGES);
  const int64_t page_size = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page_size > 0 ? pages * page_size : INT64_MAX;
}

}  // namespace kaustik
