#include "progress_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "console.h"
#include "events.h"
#include "kaustik/base/to_integer.h"
#include "screen.h"

namespace kaustik::app {
namespace {

std::string bar_text(double fraction, size_t width) {
  const auto filled = size_t(to_integer(fraction * double(width), 0, int(width)));
  return fmt::format("[{}{}] ", std::string(filled, '#'), std::string(width - filled, '-'));
}

}  // namespace

std::string progress_text(double fraction, const std::vector<std::string>& facts, size_t columns) {
  constexpr size_t narrow = 40, wide = 80;
  std::string line;
  if (columns >= narrow) line = bar_text(fraction, columns >= wide ? 24 : 8);
  line += fmt::format("{:3.0f} %", 100 * fraction);
  for (const std::string& fact : facts) {
    if (line.size() + 2 + fact.size() > columns) break;
    line += "  " + fact;
  }
  return line.substr(0, columns);
}

void ProgressDisplay::show(const Progress& p) {
  events().progress(p);
  const bool done = p.stage == Progress::Stage::done;
  if (style_ == ProgressStyle::none) return;
  if (style_ == ProgressStyle::plain && !done && p.elapsed_s - last_printed_s_ < 5) return;
  last_printed_s_ = p.elapsed_s;
  std::vector<std::string> facts;
  facts.push_back(p.passes_total > 0 ? fmt::format("pass {}/{}", p.passes_done, p.passes_total)
                                     : fmt::format("pass {}", p.passes_done));
  if (done)
    facts.push_back(duration_text(p.elapsed_s));
  else if (p.remaining_s >= 0)
    facts.push_back(duration_text(p.remaining_s) + " left");
  if (std::isfinite(p.relative_error))
    facts.push_back(fmt::format("error {:.2f} %", 100 * p.relative_error));
  facts.push_back(count_text(p.rays_per_s) + "rays/s");
  if (p.photons_per_s > 0) facts.push_back(count_text(p.photons_per_s) + "photons/s");
  facts.push_back(fmt::format("{} MB", p.memory_bytes >> 20));
  print(p.fraction, facts, done);
}

void ProgressDisplay::show(double fraction, double elapsed_s) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  events().progress(fraction, elapsed_s);
  if (style_ == ProgressStyle::none || elapsed_s < 1) return;
  if (elapsed_s - last_printed_s_ < (style_ == ProgressStyle::bar ? 0.2 : 5)) return;
  last_printed_s_ = elapsed_s;
  std::vector<std::string> facts;
  if (fraction > 1e-3) facts.push_back(duration_text(elapsed_s * (1 / fraction - 1)) + " left");
  print(fraction, facts, false);
}

void ProgressDisplay::print(double fraction, const std::vector<std::string>& facts,
                            bool must_be_shown) {
  if (style_ == ProgressStyle::plain) return say("{}", progress_text(fraction, facts, 1000));
  // The last column stays free: some terminals go to the next line there.
  const auto columns = size_t(std::max(2, screen().size().columns) - 1);
  screen().show_line(progress_text(fraction, facts, columns), must_be_shown);
}

void ProgressDisplay::finish() { screen().leave(); }

}  // namespace kaustik::app
