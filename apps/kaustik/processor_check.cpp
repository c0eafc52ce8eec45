// Compiled for every x86-64 processor, and run before all else that is compiled for x86-64-v2:
// there is a message where otherwise an illegal instruction would end the program.
#include <cstdio>
#include <cstdlib>

#include "exit_codes.h"

#if defined(__x86_64__)
namespace {

/// Of x86-64-v2 the parts that processors got last. Who has them has the others.
bool has_needed_instructions() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.1") &&
         __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
}

/// 101: the first of the constructors that are the program's own.
[[gnu::constructor(101)]] void check_processor() {
  if (has_needed_instructions()) return;
  std::fputs(
      "this processor lacks instructions that Kaustik needs: SSE4.2 and POPCNT, of x86-64-v2\n"
      "  remedy: use a processor of 2009 or later; let a virtual machine show that of its host\n",
      stderr);
  std::_Exit(kaustik::app::exit_system);
}

}  // namespace
#endif
