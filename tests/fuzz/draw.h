#pragma once
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

namespace kaustik::fuzz {

/// One after the other. A list in braces is evaluated from the left to the right; the operands of
/// `+` and the arguments of a call are not, and what draws numbers there differs by the compiler.
inline std::string joined(std::initializer_list<std::string> parts) {
  std::string result;
  for (const std::string& part : parts) result += part;
  return result;
}

/// Random choices that are the same with every standard library.
class Draw {
 public:
  explicit Draw(uint64_t seed) : engine_(seed) {}

  size_t below(size_t count) { return size_t(engine_() % count); }
  /// In [0, 1).
  double unit() { return double(engine_() >> 11) * 0x1p-53; }
  bool chance(double probability) { return unit() < probability; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  template <typename T>
  T one_of(std::initializer_list<T> choices) {
    return choices.begin()[below(choices.size())];
  }
  template <typename T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace kaustik::fuzz
