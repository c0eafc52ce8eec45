#pragma once
#include <cstdint>

namespace kaustik {

/// How a part of a body's surface lies to other bodies.
struct BodyPart {
  static constexpr uint32_t nothing = 0xffffffffu;
  uint32_t shape = 0;         ///< index of the body's shape
  bool is_hidden = false;     ///< within a body that wins: the surface is not there
  uint32_t around = nothing;  ///< else the shape of the body that touches it from outside
};

}  // namespace kaustik
