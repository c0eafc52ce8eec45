#pragma once
// Loops over fixed blocks. The block borders never depend on the number of threads, so a result
// that is reduced block by block, in block order, has the same bits on any machine. The number of
// threads is that of the task arena which the caller (the session) runs in.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

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

/// Runs `body` with at most `threads` threads (0: all that there are).
template <typename Body>
void with_threads(int threads, const Body& body) {
  tbb::task_arena arena(threads > 0 ? threads : int(tbb::task_arena::automatic));
  arena.execute([&] { body(); });
}

}  // namespace kaustik
