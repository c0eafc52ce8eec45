#include "console.h"

#include <fmt/format.h>

#include <cstdint>

#include "kaustik/base/to_integer.h"

namespace kaustik::app {

std::string duration_text(double seconds) {
  const auto s = to_integer(seconds + 0.5, int64_t(0), int64_t(1) << 53);
  if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
  if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return seconds < 9.95 ? fmt::format("{:.1f} s", seconds) : fmt::format("{} s", s);
}

std::string count_text(double count) {
  if (count >= 1e9) return fmt::format("{:.2f} G", count / 1e9);
  if (count >= 1e6) return fmt::format("{:.2f} M", count / 1e6);
  if (count >= 1e3) return fmt::format("{:.1f} k", count / 1e3);
  return fmt::format("{:.0f} ", count);
}

}  // namespace kaustik::app
