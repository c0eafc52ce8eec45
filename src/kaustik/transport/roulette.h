#pragma once
#include <algorithm>

#include "kaustik/transport/path_state.h"

namespace kaustik {

/// Events after which no path goes on for certain.
inline constexpr int certain_events = 64;

/// Largest chance with which a path goes on after so many events, for light that total reflection,
/// perfect mirrors or white surfaces and media trap without absorbing it. It leaves (c/n)² of the
/// paths after n events, c = certain_events: 2 c events in the mean where nothing is ever absorbed.
/// The weights of those that go on grow as n², which any absorption outweighs. (With a chance q for
/// every event they grow as 1/qⁿ: their variance is infinite where what is reflected is more than
/// √q, as in a room of white walls.)
inline float length_survival(int events) {
  if (events < certain_events) return 1;
  const float share = float(events) / float(events + 1);
  return share * share;
}

/// Roulette of paths from the camera, `u` in [0, 1): one goes on with the chance `share`, or 1 if
/// that is more, and length_survival(). False if it ends; else it counts for those that do.
inline bool survive_roulette(PathState& state, float share, float u) {
  const float survival = std::min(1.0f, share) * length_survival(state.depth);
  if (!(u < survival)) return false;
  state.throughput *= 1 / survival;
  return true;
}

}  // namespace kaustik
