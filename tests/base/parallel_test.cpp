#include "kaustik/base/parallel.h"
#include "kaustik/base/processors.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace kaustik {
namespace {

TEST(ParallelBlocks, CoverTheRangeOnce) {
  for (const size_t count : {0, 1, 6, 7, 8, 1000}) {
    std::vector<int> seen(count);
    std::vector<size_t> ends((count + 6) / 7);
    parallel_blocks(count, 7, [&](size_t begin, size_t end, size_t block) {
      EXPECT_EQ(begin, 7 * block);
      ends[block] = end;
      for (size_t i = begin; i < end; ++i) ++seen[i];
    });
    EXPECT_EQ(seen, std::vector<int>(count, 1));
    for (size_t block = 0; block < ends.size(); ++block)
      EXPECT_EQ(ends[block], std::min(count, 7 * (block + 1)));
  }
}

TEST(ParallelBlocks, NestAndHandOnWhatIsThrown) {
  std::vector<double> sums(100);
  parallel_blocks(sums.size(), 1, [&](size_t i, size_t, size_t) {
    sums[i] = sum_over_blocks(i, 3, [](size_t begin, size_t end) { return double(end - begin); });
  });
  for (size_t i = 0; i < sums.size(); ++i) EXPECT_EQ(sums[i], double(i));
  const std::string message(100, 'x');
  for (int round = 0; round < 50; ++round) {
    try {
      parallel_blocks(100, 1, [&](size_t i, size_t, size_t) {
        if (i % 10 == 9) throw std::runtime_error(message);
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), message);
    }
  }
}

TEST(InParallel, CallsBoth) {
  int first = 0, second = 0;
  in_parallel([&] { first = 1; }, [&] { second = 2; });
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 2);
  EXPECT_THROW(in_parallel([] { throw std::logic_error("first"); }, [] {}), std::logic_error);
}

TEST(Isolated, ReturnsWhatItsBodyDoes) {
  const auto number = isolated([] { return std::make_unique<int>(7); });
  EXPECT_EQ(*number, 7);
  bool called = false;
  isolated([&] { called = true; });
  EXPECT_TRUE(called);
}

TEST(WithThreads, OneThreadIsTheCaller) {
  with_threads(1, [&] {
    const auto caller = std::this_thread::get_id();
    parallel_blocks(100, 1,
                    [&](size_t, size_t, size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
  });
}

#ifdef KAUSTIK_THREAD_SANITIZER

// That the thread sanitizer still sees what tasks do to one another, and only that.

/// Waits until both of two tasks have called this: then different threads run them.
void meet(std::atomic<int>& arrived) {
  arrived.fetch_add(1, std::memory_order_relaxed);  // which orders nothing
  const auto begin = std::chrono::steady_clock::now();
  while (arrived.load(std::memory_order_relaxed) < 2)
    if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(60)) _exit(3);
}

constexpr int exit_race = 66;

/// A race that the sanitizer is sure to see: of two accesses at the very same time it may miss one.
void add_often(int& counter) {
  for (int i = 0; i < 1000; ++i) {
    ++counter;
    std::this_thread::yield();
  }
}

class PlantedRace : public ::testing::Test {
 protected:
  void SetUp() override {
    if (usable_processors() < 2) GTEST_SKIP() << "needs two threads";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
  }
};
using PlantedRaceDeathTest = PlantedRace;

TEST_F(PlantedRaceDeathTest, OfTwoBlocksIsFound) {
  const auto count = [] {
    std::atomic<int> arrived = 0;
    int counter = 0;
    parallel_blocks(2, 1, [&](size_t, size_t, size_t) {
      meet(arrived);
      add_often(counter);
    });
    _exit(counter > 0 ? 0 : 1);
  };
  EXPECT_EXIT(count(), ::testing::ExitedWithCode(exit_race), "data race");
}

TEST_F(PlantedRaceDeathTest, OfTwoCallsIsFound) {
  const auto count = [] {
    std::atomic<int> arrived = 0;
    std::vector<int> counter(1);
    const auto add = [&] {
      meet(arrived);
      add_often(counter[0]);
    };
    in_parallel(add, add);
    _exit(counter[0] > 0 ? 0 : 1);
  };
  EXPECT_EXIT(count(), ::testing::ExitedWithCode(exit_race), "data race");
}

TEST_F(PlantedRaceDeathTest, IsNoneWhereTasksAreOrdered) {
  const auto count = [] {
    std::atomic<int> arrived = 0, counter = 0;
    std::vector<int> before = {1, 2}, after(2);
    parallel_blocks(2, 1, [&](size_t i, size_t, size_t) {
      meet(arrived);
      counter += after[i] = before[i];
    });
    before = after;
    _exit(counter == 3 && before[1] == 2 ? 0 : 1);
  };
  EXPECT_EXIT(count(), ::testing::ExitedWithCode(0), "");
}

#endif

}  // namespace
}  // namespace kaustik
