#include "kaustik/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "kaustik/base/processors.h"
#include "kaustik/base/thread_order.h"

namespace kaustik::parallel_details {
namespace {

/// What the caller and its tasks owe each other: tasks begin after the order is made, and end
/// before it is destroyed. oneTBB sees to it. The thread sanitizer, which sees nothing of oneTBB
/// (this file is compiled without it, see CMakeLists.txt), is told here. It is told no more than
/// that: two tasks have no order, so a race of theirs is found even where oneTBB ran one after the
/// other.
class TaskOrder {
 public:
  TaskOrder() { happens_before(&begin_); }
  ~TaskOrder() { happens_after(&end_); }
  TaskOrder(const TaskOrder&) = delete;
  TaskOrder& operator=(const TaskOrder&) = delete;
  template <typename Task>
  void run(const Task& task) const {
    // A task that throws has ended as well.
    struct End {
      const char& place;
      ~End() { happens_before(&place); }
    };
    happens_after(&begin_);
    const End end{end_};
    task();
  }

 private:
  char begin_ = 0, end_ = 0;  ///< only their places count
};

}  // namespace

void run_blocks(size_t count, size_t block_size, BlockCall body) {
  const size_t blocks = (count + block_size - 1) / block_size;
  const TaskOrder order;
  tbb::parallel_for(
      tbb::blocked_range<size_t>(0, blocks, 1),
      [&](const tbb::blocked_range<size_t>& range) {
        order.run([&] {
          for (size_t block = range.begin(); block != range.end(); ++block)
            body(block * block_size, std::min(count, (block + 1) * block_size), block);
        });
      },
      tbb::simple_partitioner());
}

void run_both(Call<> first, Call<> second) {
  const TaskOrder order;
  tbb::parallel_invoke([&] { order.run(first); }, [&] { order.run(second); });
}

void run_with_threads(int threads, Call<> body) {
  tbb::task_arena arena(threads > 0 ? threads : usable_processors());
  // Where all its places are taken another thread runs the body.
  const TaskOrder order;
  arena.execute([&] { order.run(body); });
}

void run_isolated(Call<> body) { tbb::this_task_arena::isolate(body); }

}  // namespace kaustik::parallel_details
