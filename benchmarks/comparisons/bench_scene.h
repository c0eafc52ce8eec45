#pragma once
#include <string>
#include <utility>
#include <vector>

namespace kaustik::bench {

/// The time that other renderers had for their figures.
inline constexpr double peer_seconds = 20;
/// When the scenes that ship have to keep their bars beside path tracing.
inline constexpr double bar_seconds = 60;

/// Relative MSE that another renderer reaches in that time.
struct PeerFigure {
  std::string renderer;
  double relmse;
};

/// A scene that methods are measured on.
struct BenchScene {
  std::string name;       ///< as in results: "metal_ring"; "peer_ring" of benchmarks/peer_scenes
  std::string file;       ///< path of the scene file
  std::string reference;  ///< path of the stored reference; its size becomes the picture's
  std::vector<double> seconds;    ///< when the picture is looked at, unless one asks for others
  std::vector<uint64_t> seeds;    ///< likewise
  std::vector<PeerFigure> peers;  ///< only of scenes whose reference others made
  /// How many times less than path tracing's, or than the least of the peers', our error has to be,
  /// and should be; 0: nothing is asked.
  double bar = 0, aim = 0;
  bool is_peer() const { return !peers.empty(); }
};

/// What is measured when no scene is named: six that ship, and the six of benchmarks/peer_scenes.
std::vector<std::string> default_scene_names();

/// Any scene of those folders, or of benchmarks/scenes. Throws Error(input) if there is none of
/// that name.
BenchScene bench_scene(const std::string& name);

}  // namespace kaustik::bench
