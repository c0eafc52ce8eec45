#pragma once
// Loops over fixed blocks. The block borders never depend on the number of threads, so a result
// that is reduced block by block, in block order, has the same bits on any machine. The number of
// threads is that of the task arena which the caller (the session) runs in.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace kaustik {

/// Calls body(begin, end, block) for every block of [0, count), in parallel.
template <typename Body>
void parallel_blocks(size_t count, size_t block_size, const Body& body) {
  const size_t blocks = (count + block_size - 1) / block_size;
  tbb::parallel_for(
      tbb::blocked_range<size_t>(0, blocks, 1),
      [&](const tbb::blocked_range<size_t>& range) {
        for (size_t block = range.begin(); block != range.end(); ++block)
          body(block * block_size, std::min(count, (block + 1) * block_size), block);
      },
      tbb::simple_partitioner());
}

/// Sum of what `sum_of(begin, end)` returns for every block of [0, count), computed in parallel,
/// added in their order.
template <typename SumOf>
double sum_over_blocks(size_t count, size_t block_size, const SumOf& sum_of) {
  std::vector<double> sums((count + block_size - 1) / block_size);
  parallel_blocks(count, block_size, [&](size_t begin, size_t end, size_t block) {
    sums[block] = sum_of(begin, end);
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// Runs `body` with at most `threads` threads (0: all that there are).
template <typename Body>
void with_threads(int threads, const Body& body) {
  tbb::task_arena arena(threads > 0 ? threads : int(tbb::task_arena::automatic));
  arena.execute([&] { body(); });
}

/// Runs `body` so that a thread which waits in it for others takes up no work but that of `body`:
/// needed where it holds a lock.
template <typename Body>
auto isolated(const Body& body) {
  return tbb::this_task_arena::isolate(body);
}

}  // namespace kaustik
