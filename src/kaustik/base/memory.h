#pragma once
#include <cstdint>

namespace kaustik {

/// Of this machine; the largest number there is where the system does not tell.
int64_t physical_memory_bytes();

}  // namespace kaustik
