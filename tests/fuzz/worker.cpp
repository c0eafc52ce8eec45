#include "tests/fuzz/worker.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <ctime>
#include <new>
#include <stdexcept>

#include "tests/fuzz/scene_check.h"

namespace kaustik::fuzz {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr double longest_step_s = 60;
#else
constexpr double longest_step_s = 20;
#endif
/// By the clock on the wall, for what waits without working; machines may be busy with others.
constexpr double longest_wait_s = 20 * longest_step_s;

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Processor time that a process took so far.
double work_of(pid_t process) {
  clockid_t clock{};
  return clock_getcpuclockid(process, &clock) == 0 ? seconds_of(clock) : 0;
}

/// The scene as far as a stage of check_scene() sees it.
std::string xml_of(const GeneratedScene& scene, uint64_t stage) {
  return scene.with(stage < scene.integrators.size() ? scene.integrators[stage].xml : "");
}

}  // namespace

void tell_failure(uint64_t seed, const std::string& what, const std::string& xml) {
  const std::string text = fmt::format(
      "=== seed {}: {}\n{}=== again: fuzz_scenes --first {} --scenes 1\n", seed, what, xml, seed);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

Worker::Worker(uint64_t first, uint64_t end, uint64_t stride, std::string folder,
               bool tells_refusals, Counts& counts)
    : end_(end),
      stride_(stride),
      folder_(std::move(folder)),
      tells_refusals_(tells_refusals),
      counts_(counts) {
  void* shared =
      mmap(nullptr, sizeof(Position), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::runtime_error("no memory to share with a process");
  position_ = new (shared) Position;
  start(first);
}

Worker::~Worker() { munmap(position_, sizeof(Position)); }

void Worker::start(uint64_t first) {
  if (first >= end_) return;
  position_->seed = first;
  position_->stage = 0;
  step_work_s_ = 0;
  step_begin_s_ = seconds_of(CLOCK_MONOTONIC);
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("no new process can be made");
  if (process_ > 0) return;
  // It does not outlive its parent, which may have ended before the system was told so.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  work(first);
}

void Worker::work(uint64_t first) {
  for (uint64_t seed = first; seed < end_; seed += stride_) {
    position_->seed = seed;
    const GeneratedScene scene = generate_scene(seed, folder_);
    counts_.wanted += scene.integrators.size();
    const SceneResult result = check_scene(scene, [this](size_t stage) {
      position_->stage = stage;
      ++position_->steps;
    });
    for (const auto& [what, xml] : result.failures) tell_failure(seed, what, xml);
    if (tells_refusals_)
      for (const std::string& refusal : result.refusals)
        fmt::print(stderr, "=== seed {} is refused: {}\n", seed, refusal);
    ++counts_.scenes;
    counts_.refused += result.refused;
    counts_.renders += uint64_t(result.renders);
    counts_.renders_refused += uint64_t(result.renders_refused);
    counts_.dropped += uint64_t(result.dropped);
    counts_.with_lost_rays += uint64_t(result.with_lost_rays);
    counts_.failures += result.failures.size();
  }
  // No destructors: the parent's objects are the parent's.
  std::fflush(stderr);
  _exit(0);
}

bool Worker::attend() {
  if (process_ < 0) return false;
  int status = 0;
  if (waitpid(process_, &status, WNOHANG) == 0) {
    if (position_->steps != steps_seen_) {
      steps_seen_ = position_->steps;
      step_work_s_ = work_of(process_);
      step_begin_s_ = seconds_of(CLOCK_MONOTONIC);
    }
    if (work_of(process_) - step_work_s_ < longest_step_s &&
        seconds_of(CLOCK_MONOTONIC) - step_begin_s_ < longest_wait_s)
      return true;
    kill(process_, SIGKILL);
    waitpid(process_, &status, 0);
    tell_end(status, true);
  } else if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    process_ = -1;
    return false;
  } else {
    tell_end(status, false);
  }
  process_ = -1;
  start(position_->seed + stride_);
  return process_ >= 0;
}

void Worker::tell_end(int status, bool hung) {
  const std::string what =
      hung                  ? fmt::format("took more than {} s of processor time", longest_step_s)
      : WIFSIGNALED(status) ? fmt::format("ended by signal {}", WTERMSIG(status))
                            : fmt::format("ended with {}", WEXITSTATUS(status));
  ++counts_.scenes;
  ++counts_.failures;
  tell_failure(position_->seed, what,
               xml_of(generate_scene(position_->seed, folder_), position_->stage));
}

}  // namespace kaustik::fuzz
