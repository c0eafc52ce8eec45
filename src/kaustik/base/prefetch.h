#pragma once

namespace kaustik {

/// Asks for the memory there, to be read soon; the address may be any.
inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  // Else g++ takes functions that do nothing but this for ones without an effect, and drops them.
  asm volatile("");
}

}  // namespace kaustik
