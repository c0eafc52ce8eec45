#pragma once
// Loops over fixed blocks. The block borders never depend on the number of threads, so a result
// that is reduced block by block, in block order, has the same bits on any machine. The number of
// threads is that of the task arena which the caller (the session) runs in.

#include <cstddef>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace kaustik {

namespace parallel_details {

/// Calls a function object that lives until the call returns to which this is handed.
template <typename... Arguments>
class Call {
 public:
  template <typename Body>
  explicit Call(const Body& body)
      : body_(&body), call_([](const void* of, Arguments... arguments) {
          (*static_cast<const Body*>(of))(arguments...);
        }) {}
  void operator()(Arguments... arguments) const { call_(body_, arguments...); }

 private:
  const void* body_;
  void (*call_)(const void*, Arguments...);
};
using BlockCall = Call<size_t, size_t, size_t>;

// parallel.cpp alone knows the scheduler.
void run_blocks(size_t count, size_t block_size, BlockCall body);
void run_both(Call<> first, Call<> second);
void run_with_threads(int threads, Call<> body);
void run_isolated(Call<> body);

}  // namespace parallel_details

/// Calls body(begin, end, block) for every block of [0, count), in parallel.
template <typename Body>
void parallel_blocks(size_t count, size_t block_size, const Body& body) {
  parallel_details::run_blocks(count, block_size, parallel_details::BlockCall(body));
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

/// Calls both, in parallel.
template <typename First, typename Second>
void in_parallel(const First& first, const Second& second) {
  parallel_details::run_both(parallel_details::Call<>(first), parallel_details::Call<>(second));
}

/// Runs `body` with at most `threads` threads (0: all that there are).
template <typename Body>
void with_threads(int threads, const Body& body) {
  parallel_details::run_with_threads(threads, parallel_details::Call<>(body));
}

/// What `body` returns, run so that a thread which waits in it for others takes up no work but that
/// of `body`: needed where it holds a lock.
template <typename Body>
auto isolated(const Body& body) {
  using Result = std::invoke_result_t<const Body&>;
  if constexpr (std::is_void_v<Result>) {
    parallel_details::run_isolated(parallel_details::Call<>(body));
  } else {
    std::optional<Result> result;
    const auto keep = [&] { result.emplace(body()); };
    parallel_details::run_isolated(parallel_details::Call<>(keep));
    return std::move(*result);
  }
}

}  // namespace kaustik
