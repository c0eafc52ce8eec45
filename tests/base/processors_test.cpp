#include "kaustik/base/processors.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "kaustik/base/parallel.h"
#include "kaustik/base/thread_limit.h"

namespace kaustik {
namespace {

TEST(UsableProcessors, PartsOfAProcessorCountAsOne) {
  EXPECT_EQ((Processors{16, 8, 3.0}.usable()), 3);
  EXPECT_EQ((Processors{16, 8, 3.1}.usable()), 4);
  EXPECT_EQ((Processors{16, 8, 0.2}.usable()), 1);
  EXPECT_EQ((Processors{16, 8, 7.5}.usable()), 8);
  EXPECT_EQ((Processors{16, 8, 1e12}.usable()), 8);
  EXPECT_EQ((Processors{16, 8}.usable()), 8);
}

/// In a thread of its own, which alone is bound.
template <typename Body>
void bound_to_one(const Body& body) {
  std::thread([&] {
    cpu_set_t mask;
    ASSERT_EQ(::sched_getaffinity(0, sizeof mask, &mask), 0);
    int first = 0;
    while (!CPU_ISSET(first, &mask)) ++first;
    CPU_ZERO(&mask);
    CPU_SET(first, &mask);
    ASSERT_EQ(::sched_setaffinity(0, sizeof mask, &mask), 0);
    body();
  }).join();
}

TEST(UsableProcessors, FollowTheAffinityMask) {
  const Processors before = processors();
  EXPECT_GE(before.of_machine, before.bound);
  bound_to_one([&] {
    const Processors here = processors();
    EXPECT_EQ(here.of_machine, before.of_machine);
    EXPECT_EQ(here.bound, 1);
    EXPECT_EQ(usable_processors(), 1);
  });
  EXPECT_EQ(processors().bound, before.bound);
}

/// How many threads take part in a loop that gives each of them a while to come.
size_t threads_of_a_loop() {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  parallel_blocks(64, 1, [&](size_t, size_t, size_t) {
    {
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  return seen.size();
}

TEST(UsableProcessors, AreWhatAllThreadsMeans) {
  bound_to_one([] { with_threads(0, [] { EXPECT_EQ(threads_of_a_loop(), 1u); }); });
}

TEST(UsableProcessors, ALimitHoldsForAllLoops) {
  const ThreadLimit limit(1);
  EXPECT_EQ(threads_of_a_loop(), 1u);
  with_threads(4, [] { EXPECT_EQ(threads_of_a_loop(), 1u); });
}

}  // namespace
}  // namespace kaustik
