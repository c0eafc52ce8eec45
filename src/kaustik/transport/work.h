#pragma once
#include <cstdint>

#include "kaustik/base/scratch.h"

namespace kaustik {

/// What is handed on to all that trace rays.
struct Work {
  uint64_t& rays;    ///< traced: a count
  Scratch& scratch;  ///< lists that they need meanwhile
};

}  // namespace kaustik
