#pragma once
#include <optional>
#include <string>
#include <vector>

namespace kaustik::bench {

/// The mean of a picture that has a bar may differ from ours by this fraction. Otherwise it may not
/// be the same scene, and its bar cannot be told.
inline constexpr double mean_tolerance = 0.02;

/// A scene as another renderer and ours made it in the same time: one line of a results file of
/// bench_peers.
struct PeerResult {
  std::string scene, peer;  ///< "metal_ring", "cycles"
  double seconds = 0, start_up_seconds = 0;
  std::string effort;  ///< "512 samples per pixel"
  double relmse = 0;
  std::string integrator;  ///< ours
  double our_relmse = 0;
  uint32_t our_passes = 0;
  double our_load_seconds = 0;
  double mean_ratio = 0;        ///< of the peer's mean to ours
  double bar = 0;               ///< how many times less our error has to be; 0: there is no bar
  double aim = 0;               ///< and should be
  double reference_relmse = 0;  ///< of the reference's own noise; NaN: it does not tell
  int threads = 0;
  uint64_t seed = 0;
  std::string program;  ///< checksum of the program that measured

  /// Whether the means of both pictures agree within mean_tolerance.
  bool has_our_mean() const;
  std::string to_json_line() const;
};

/// Of a results file: of each scene and peer the newest, in the order in which they were measured
/// first. None without the file. Throws Error(input) for lines that are no JSON.
std::vector<PeerResult> read_peer_results(const std::string& path);

/// Beside each peer the errors, their ratio and what becomes of its bar, in Markdown.
std::string peer_result_table(const std::vector<PeerResult>& results);

/// Whether there are results, and all bars are kept.
bool all_bars_kept(const std::vector<PeerResult>& results);

}  // namespace kaustik::bench
