#pragma once
// What the thread sanitizer is told of an order that it can't see, because a library makes it that
// is built without it. Nothing is done in other builds.

#ifdef KAUSTIK_THREAD_SANITIZER
// As <sanitizer/tsan_interface.h> declares them, which installed headers don't show.
extern "C" void __tsan_acquire(void* place);
extern "C" void __tsan_release(void* place);
#endif

namespace kaustik {

/// All that this thread has done comes before what a thread does after it calls happens_after() of
/// the same place. A place is an address, of anything.
inline void happens_before([[maybe_unused]] const void* place) {
#ifdef KAUSTIK_THREAD_SANITIZER
  __tsan_release(const_cast<void*>(place));
#endif
}

inline void happens_after([[maybe_unused]] const void* place) {
#ifdef KAUSTIK_THREAD_SANITIZER
  __tsan_acquire(const_cast<void*>(place));
#endif
}

}  // namespace kaustik
