#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kaustik::bench {

/// An integrator as it is named here may have settings, each after this sign: type:name=value.
inline constexpr char setting_separator = ':';
inline std::string type_of(const std::string& integrator) {
  return integrator.substr(0, integrator.find(setting_separator));
}

/// What the renders of an integrator on a scene came to: one line of a results file.
struct Measurement {
  std::string scene, integrator;
  uint64_t seed = 0;
  std::vector<double> seconds;  ///< one render for each; loading the scene is not in it
  /// Error (error_of in quality.h) of the picture of each; NaN (null in the file): there is none.
  std::vector<double> relmse;
  std::vector<double> seconds_taken;  ///< when each was over
  double mean_ratio = 0;  ///< of the last picture's mean to the reference's; NaN: no picture
  int threads = 0;
  uint32_t passes = 0, samples_per_pass = 0;
  double load_seconds = 0;
  /// CPU time over time × threads, at most 1; much less: others had the processors as well, or the
  /// method does not use them all.
  double cpu_share = 0;
  double reference_relmse = 0;  ///< of the reference's own noise; NaN: it does not tell
  /// Of its mean to that of the reference that came with the scene; NaN: there is no other.
  double reference_mean_ratio = 0;
  std::string program;  ///< checksum of the program that measured
  std::string inputs;   ///< digests of the scene and the integrator, checksum of the reference

  /// The error at one of `seconds`; nothing if there was no render for it.
  std::optional<double> relmse_at(double time) const;
  std::string to_json_line() const;
};

/// Of a results file, in its order; lines of other kinds are passed over. None without the file.
/// Throws Error(input) for lines that are no JSON.
std::vector<Measurement> read_measurements(const std::string& path);
/// Adds a line at the end of a results file, which is made with its folder if it is missing.
void append_line(const std::string& path, const std::string& line);

/// Where the last picture of a run is kept, beside the results.
std::string picture_path(const std::string& results, const std::string& scene,
                         const std::string& integrator);

/// In hexadecimal.
std::string checksum_of_file(const std::string& path);

}  // namespace kaustik::bench
