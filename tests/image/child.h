#pragma once
// What is done in a process of its own: to measure its memory, and to limit it.

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <new>
#include <stdexcept>

namespace kaustik::testing {

/// Runs `action` in a child of this process and returns what it does; throws if it does not end
/// well.
inline int64_t result_in_child(const std::function<int64_t()>& action) {
  void* const shared =
      ::mmap(nullptr, sizeof(int64_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::bad_alloc();
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    try {
      *static_cast<int64_t*>(shared) = action();
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  const int64_t result = *static_cast<int64_t*>(shared);
  ::munmap(shared, sizeof(int64_t));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error("the child failed");
  return result;
}

/// By how many bytes memory in use grows at most while `action` runs. The peak of a child begins
/// with what its parent has at the moment, not with what that had at its own peak.
inline int64_t memory_growth(const std::function<void()>& action) {
  const auto peak = [] {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return 1024 * int64_t(usage.ru_maxrss);
  };
  return result_in_child([&] {
    const int64_t before = peak();
    action();
    return peak() - before;
  });
}

/// Bytes of address space that this process has.
inline int64_t address_space() {
  long pages = 0;
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  if (!file || std::fscanf(file, "%ld", &pages) != 1) throw std::runtime_error("no /proc");
  std::fclose(file);
  return pages * ::sysconf(_SC_PAGESIZE);
}

/// Lets this process have so many bytes more than it has.
inline void limit_memory(int64_t more) {
  const rlim_t most = rlim_t(address_space() + more);
  const rlimit both{most, most};
  ::setrlimit(RLIMIT_AS, &both);
}

}  // namespace kaustik::testing
