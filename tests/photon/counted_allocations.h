#pragma once
#include <cstdint>

namespace kaustik::test {

/// How often this program has called operator new; 0 under sanitizers, which have their own.
int64_t allocation_count();

}  // namespace kaustik::test
