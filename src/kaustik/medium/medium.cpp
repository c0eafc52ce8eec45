#include "kaustik/medium/medium.h"

#include <cassert>

namespace kaustik {

Medium::Medium(std::shared_ptr<const PhaseFunction> phase, bool scatters)
    : phase_(std::move(phase)), scatters_(scatters) {
  assert(phase_);
}

}  // namespace kaustik
