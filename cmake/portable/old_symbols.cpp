// The program and the module for Python ask for glibc 2.34 and the libstdc++ of GCC 11, as the
// libraries do that the tarball and the wheel carry. Three functions have later versions. These
// differ only in how they tell of errors, and nobody asks for that here. The values are the same to
// the bit. Sources of the rooms that call the functions get these, since the linker looks here
// first.
#include <condition_variable>
#include <mutex>

#if defined(__x86_64__) && defined(__GLIBC__)

// hypot without errno: glibc 2.35.
#if __GLIBC_PREREQ(2, 35)
extern "C" {
double kaustik_old_hypot(double x, double y);
float kaustik_old_hypotf(float x, float y);
double kaustik_hypot(double x, double y) __asm__("hypot") __attribute__((visibility("hidden")));
float kaustik_hypotf(float x, float y) __asm__("hypotf") __attribute__((visibility("hidden")));
}
__asm__(".symver kaustik_old_hypot, hypot@GLIBC_2.2.5");
__asm__(".symver kaustik_old_hypotf, hypotf@GLIBC_2.2.5");
double kaustik_hypot(double x, double y) { return kaustik_old_hypot(x, y); }
float kaustik_hypotf(float x, float y) { return kaustik_old_hypotf(x, y); }
#endif

// wait() that throws nothing: GCC 12.
#if defined(_GLIBCXX_RELEASE) && _GLIBCXX_RELEASE >= 12
using Lock = std::unique_lock<std::mutex>;
extern "C" {
void kaustik_old_wait(std::condition_variable* self, Lock& lock);
void kaustik_wait(std::condition_variable* self,
                  Lock& lock) __asm__("_ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE")
    __attribute__((visibility("hidden")));
}
__asm__(
    ".symver kaustik_old_wait, "
    "_ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE@GLIBCXX_3.4.11");
void kaustik_wait(std::condition_variable* self, Lock& lock) { kaustik_old_wait(self, lock); }
#endif

#endif
