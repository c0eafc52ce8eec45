#include "sampling_profiler.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <signal.h>
#include <sys/time.h>

#include <atomic>
#include <cstring>
#include <unordered_map>

namespace kaustik::thesis {
namespace {

constexpr size_t maximum_samples = 1 << 17;
constexpr int maximum_depth = 48;
constexpr int microseconds = 2000;

struct Sample {
  int depth = 0;
  std::array<void*, maximum_depth> stack;
};

// The signal handler may touch nothing else.
std::vector<Sample> samples;
std::atomic<size_t> used{0};

void take_sample(int) {
  const size_t index = used.fetch_add(1, std::memory_order_relaxed);
  if (index >= samples.size()) return;
  samples[index].depth = backtrace(samples[index].stack.data(), maximum_depth);
}

void set_timer(int interval) {
  itimerval timer{};
  timer.it_interval.tv_usec = timer.it_value.tv_usec = interval;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

/// Mangled; the names of classes and functions stand in it as they are.
std::string function_name(void* address) {
  Dl_info info{};
  return dladdr(address, &info) != 0 && info.dli_sname ? info.dli_sname : "";
}

}  // namespace

SamplingProfiler::SamplingProfiler() {
  samples.assign(maximum_samples, {});
  used = 0;
  void* warm_up[2];
  backtrace(warm_up, 2);  // loads what it needs, which a signal handler must not
  struct sigaction action {};
  action.sa_handler = take_sample;
  action.sa_flags = SA_RESTART;
  sigaction(SIGPROF, &action, nullptr);
  set_timer(microseconds);
}

SamplingProfiler::~SamplingProfiler() {
  set_timer(0);
  signal(SIGPROF, SIG_IGN);
}

size_t SamplingProfiler::sample_count() const { return std::min(used.load(), samples.size()); }

std::vector<double> SamplingProfiler::shares(const std::vector<ProfileStage>& stages) {
  set_timer(0);
  std::unordered_map<void*, std::string> names;
  const auto name_of = [&](void* address) -> const std::string& {
    const auto [entry, is_new] = names.try_emplace(address);
    if (is_new) entry->second = function_name(address);
    return entry->second;
  };
  const auto stage_of = [&](const Sample& sample) {
    for (size_t stage = 0; stage < stages.size(); ++stage)
      for (int level = 0; level < sample.depth; ++level)
        for (const char* part : stages[stage].function_names)
          if (name_of(sample.stack[size_t(level)]).find(part) != std::string::npos) return stage;
    return stages.size();
  };
  std::vector<double> result(stages.size() + 1);
  for (size_t i = 0; i < sample_count(); ++i)
    result[stage_of(samples[i])] += 1 / double(sample_count());
  return result;
}

}  // namespace kaustik::thesis
