#pragma once

namespace kaustik {

/// Light that an integrator has traced, as far as neither the camera nor the film makes a
/// difference to it. Immutable, and of use while the scene that it was traced in is gone.
class KeptLight {
 public:
  virtual ~KeptLight() = default;
};

}  // namespace kaustik
