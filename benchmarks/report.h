#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace kaustik::bench {

/// What a claim has to reach at least, and should; 0: nothing is asked.
struct Bar {
  double bar = 0, aim = 0;
};

/// One measured claim as a line of JSON on standard output, with what becomes of its bar.
inline void report(const std::string& name, double value, const std::string& unit,
                   const std::string& compared_with, const Bar& asked = {}) {
  std::string outcome;
  const auto add = [&](const char* what, double least) {
    if (least > 0)
      outcome += fmt::format(", \"{0}\": {1:g}, \"{0}_is\": \"{2}\"", what, least,
                             value >= least ? "kept" : "missed");
  };
  add("bar", asked.bar);
  add("aim", asked.aim);
  fmt::print(
      "{{\"name\": \"{}\", \"value\": {:.4g}, \"unit\": \"{}\", \"compared_with\": \"{}\"{}}}\n",
      name, value, unit, compared_with, outcome);
  std::fflush(stdout);
}

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <typename Body>
double seconds_of(const Body& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return seconds_since(start);
}

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace kaustik::bench
