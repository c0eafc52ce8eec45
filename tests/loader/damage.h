#pragma once
// Damaged copies of a text, for readers that must return or throw whatever the bytes.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "kaustik/base/error.h"

namespace kaustik {

/// Makes one change in a text.
using Change = std::function<void(std::string& text, std::mt19937& random)>;

/// How many damaged texts are tried: fewer in builds that are slow, as many as the environment
/// variable KAUSTIK_DAMAGE_ROUNDS says, if it is set.
inline int damage_rounds([[maybe_unused]] int usual, [[maybe_unused]] int in_slow_builds) {
  if (const char* asked = std::getenv("KAUSTIK_DAMAGE_ROUNDS"))
    return std::max(1, std::atoi(asked));
#ifdef KAUSTIK_SLOW_BUILD
  return in_slow_builds;
#else
  return usual;
#endif
}

/// Where rounds are asked for: prints how many texts were tried, and how long they took.
class DamageReport {
 public:
  /// A text is tried now. The file of KAUSTIK_DAMAGE_KEEP has it, if the program does not survive.
  void begin(const std::string& text) {
    if (const char* kept = std::getenv("KAUSTIK_DAMAGE_KEEP"))
      std::ofstream(kept, std::ios::binary) << text;
    begun_ = Clock::now();
  }
  void end() {
    const double seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
    ++texts_;
    seconds_ += seconds;
    slowest_ = std::max(slowest_, seconds);
  }
  void print(unsigned seed, int refused) const {
    if (!std::getenv("KAUSTIK_DAMAGE_ROUNDS")) return;
    std::printf("seed %u: %d texts, %d refused, %.0f s, %.1f ms each, the slowest %.2f s\n", seed,
                texts_, refused, seconds_, 1e3 * seconds_ / std::max(texts_, 1), slowest_);
    std::fflush(stdout);
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begun_;
  int texts_ = 0;
  double seconds_ = 0, slowest_ = 0;
};

/// Whether read() returns true. If it throws, each problem must have a message, a remedy and a file
/// as its place.
template <typename Read>
bool is_accepted(const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    EXPECT_FALSE(error.problems().empty());
    for (const Problem& problem : error.problems()) {
      EXPECT_FALSE(problem.message.empty());
      EXPECT_FALSE(problem.remedy.empty()) << problem.message;
      EXPECT_TRUE(problem.place.file) << problem.message;
    }
  }
  return false;
}

/// Calls `survives` with so many copies of a text, each changed up to `most_changes` times. How
/// many did not survive.
template <typename Survives>
int count_refused(const std::string& whole, unsigned seed, int rounds, unsigned most_changes,
                  const Change& change, const Survives& survives) {
  std::mt19937 random(seed);
  DamageReport report;
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    std::string text = whole;
    for (size_t changes = 1 + random() % most_changes; changes > 0; --changes) change(text, random);
    report.begin(text);
    if (!survives(text)) ++refused;
    report.end();
  }
  report.print(seed, refused);
  return refused;
}

/// A byte becomes another one.
inline void flip_byte(std::string& text, std::mt19937& random) {
  text[random() % text.size()] ^= char(1 + random() % 255);
}

/// A letter becomes one of these, within the first `most` of the text.
inline Change odd_letter(std::string letters, size_t most = std::string::npos) {
  return [letters = std::move(letters), most](std::string& text, std::mt19937& random) {
    text[random() % std::min(most, text.size())] = letters[random() % letters.size()];
  };
}

/// A piece of the whole text stands in place of up to `most_removed` bytes. More of the text stays
/// sound than by single bytes.
inline Change exchanged_piece(std::string whole, size_t most_removed = 59) {
  return [whole = std::move(whole), most_removed](std::string& text, std::mt19937& random) {
    const std::string piece = whole.substr(random() % whole.size(), 1 + random() % 60);
    text.replace(random() % text.size(), random() % (most_removed + 1), piece);
  };
}

/// One of these words stands in place of up to `most_removed` bytes.
inline Change exchanged_word(std::vector<std::string> words, size_t most_removed = 7) {
  return [words = std::move(words), most_removed](std::string& text, std::mt19937& random) {
    text.replace(random() % text.size(), random() % (most_removed + 1),
                 words[random() % words.size()]);
  };
}

/// One of the two, as often as the other.
inline Change either(Change first, Change second) {
  return [first = std::move(first), second = std::move(second)](std::string& text,
                                                                std::mt19937& random) {
    (random() % 2 ? first : second)(text, random);
  };
}

}  // namespace kaustik
