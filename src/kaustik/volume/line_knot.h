#pragma once

namespace kaustik {

/// A point of a straight line through a volume, and the integral of the volume up to there.
struct LineKnot {
  float distance, integral;
};

}  // namespace kaustik
