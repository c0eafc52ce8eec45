#pragma once
#include <limits>
#include <string>

namespace kaustik {

/// The most of this machine's instructions that the libraries choose by: "avx512", "avx2", "avx",
/// "sse4.2"; of other kinds of processors "aarch64" or
/// "other".
std::string instruction_set();

/// The processors of the machine, and how many of them this process may keep busy.
struct Processors {
  int of_machine = 1;  ///< that run
  int bound = 1;       ///< that the process is bound to: its affinity mask
  /// How many processors' time its control groups allow: cgroup_cpu_quota(). Infinity: no quota.
  double quota = std::numeric_limits<double>::infinity();

  /// As many threads as can run at a time, at least one. Part of a processor counts as one.
  int usable() const;
};

/// As it is now. `root`: see cgroup_cpu_quota().
Processors processors(const std::string& root = "");

/// processors().usable(): what stands for "all" wherever a number of threads is chosen.
int usable_processors();

}  // namespace kaustik
