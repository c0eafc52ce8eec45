#pragma once
#include <array>
#include <string>
#include <vector>

namespace kaustik::thesis {

/// A kind of work, and what the names of the functions that do it contain.
struct ProfileStage {
  const char* title;
  std::vector<const char*> function_names;
};

/// Asks the processor's clock many times a second in which function the program is, and whom it was
/// called by; a sample belongs to the first of the stages whose function is on the stack. One
/// profiler at a time, for work on one thread.
class SamplingProfiler {
 public:
  SamplingProfiler();
  ~SamplingProfiler();
  SamplingProfiler(const SamplingProfiler&) = delete;
  SamplingProfiler& operator=(const SamplingProfiler&) = delete;

  /// Stops asking. Shares of the stages in their order, then that of everything else; they sum
  /// to 1.
  std::vector<double> shares(const std::vector<ProfileStage>& stages);
  size_t sample_count() const;
};

}  // namespace kaustik::thesis
