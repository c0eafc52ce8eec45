#include "kaustik/base/thread_limit.h"

#include <tbb/global_control.h>

namespace kaustik {

struct ThreadLimit::Control {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{{tbb::global_control::max_allowed_parallelism, size_t(threads)}}) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace kaustik
