#pragma once
#include "benchmarks/peers/peer_process.h"
#include "benchmarks/peers/peer_scene.h"

namespace kaustik::bench {

/// The scene in POV-Ray's language, for `effort` times the least samples: lamps as area lights that
/// fall off with the squared distance and, where they are flat, with the cosine; radiosity, and
/// photons for what mirrors and glass focus.
std::string povray_text(const PeerScene& scene, double effort);

/// Renders with POV-Ray, with as much effort as comes nearest to so many seconds. Not calibrated:
/// its lamps are no areas that emit, and its radiosity interpolates. Throws Error with what
/// POV-Ray said if that fails.
PeerPicture render_with_povray(const PeerScene& scene, double seconds, int threads);

}  // namespace kaustik::bench
