#pragma once
#include <cstdint>
#include <memory>

#include "kaustik/image/image.h"

namespace kaustik {

class Scene;

/// A picture as it was at a moment. Immutable once it is shared.
struct Snapshot {
  /// How good it is, ascending.
  enum class Kind : uint8_t {
    preview,  ///< Job's first look: no picture to measure anything by
    samples,  ///< of a first pass: pixels without samples show those of a pixel near by
    passes    ///< the mean of whole passes
  };

  uint64_t number = 0;    ///< of the engine's snapshots, from 1 on
  uint64_t revision = 0;  ///< of the description: how many edits it has seen
  Kind kind = Kind::preview;
  bool is_moving = false;  ///< by EngineSettings::moving
  uint32_t passes = 0;
  double elapsed_s = 0;                ///< of rendering
  std::shared_ptr<const Scene> scene;  ///< that the picture shows
  Image picture;
};

}  // namespace kaustik
