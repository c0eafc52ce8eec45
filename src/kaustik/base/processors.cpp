#include "kaustik/base/processors.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <memory>

#include "kaustik/base/cpu_quota.h"

namespace kaustik {
namespace {

/// Those in the affinity mask; 0 if the system does not tell. The kernel refuses masks that are
/// smaller than its own (EINVAL), so larger ones are tried: sched_getaffinity(2).
int bound_processors() {
  constexpr int most = 1 << 20;
  for (int room = CPU_SETSIZE; room <= most; room *= 2) {
    const std::unique_ptr<cpu_set_t, void (*)(cpu_set_t*)> mask(
        CPU_ALLOC(size_t(room)), [](cpu_set_t* set) { CPU_FREE(set); });
    if (!mask) return 0;
    const size_t bytes = CPU_ALLOC_SIZE(size_t(room));
    if (::sched_getaffinity(0, bytes, mask.get()) == 0) return CPU_COUNT_S(bytes, mask.get());
    if (errno != EINVAL) return 0;
  }
  return 0;
}

}  // namespace

std::string instruction_set() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) return "avx512";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "avx2";
  if (__builtin_cpu_supports("avx")) return "avx";
  return "sse4.2";
#elif defined(__aarch64__)
  return "aarch64";
#else
  return "other";
#endif
}

int Processors::usable() const {
  const int by_quota = quota < double(bound) ? int(std::ceil(quota)) : bound;
  return std::max(1, by_quota);
}

Processors processors(const std::string& root) {
  Processors result;
  result.of_machine = std::max(1, int(::sysconf(_SC_NPROCESSORS_ONLN)));
  const int bound = bound_processors();
  result.bound = bound > 0 ? bound : result.of_machine;
  result.quota = cgroup_cpu_quota(root);
  return result;
}

int usable_processors() { return processors().usable(); }

}  // namespace kaustik
