#pragma once
#include "benchmarks/peers/peer_process.h"
#include "benchmarks/peers/peer_scene.h"

namespace kaustik::bench {

/// Renders with Blender Cycles for so many seconds: plain path tracing on the processor, no
/// denoiser, no clamping. Throws Error with what Blender said if that fails.
PeerPicture render_with_cycles(const PeerScene& scene, double seconds, int threads, int seed);

}  // namespace kaustik::bench
