#include "kaustik/render/checkpoint_keeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

/// Share of the time that may go into checkpoints.
constexpr double most_time = 0.1;

std::chrono::steady_clock::duration duration_of(double seconds) {
  // The clock counts nanoseconds: in 64 bits they last for 292 years.
  constexpr double century_s = 3.2e9;
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(std::min(seconds, century_s)));
}

}  // namespace

CheckpointKeeper::CheckpointKeeper(std::string path, CheckpointOwner owner, double interval_s,
                                   RenderRecord record, const Integrator& integrator,
                                   std::function<void(const std::string&)> warn)
    : path_(std::move(path)),
      owner_(owner),
      interval_s_(interval_s),
      record_(std::move(record)),
      integrator_(integrator),
      warn_(std::move(warn)),
      start_(Clock::now()),
      next_(start_ + duration_of(interval_s)) {}

void CheckpointKeeper::pass_done(const Film& film) {
  if (path_.empty() || Clock::now() < next_) return;
  const auto begin = Clock::now();
  try {
    write(film);
  } catch (const std::exception& error) {
    if (warn_)
      warn_(
          fmt::format("the checkpoint could not be written, the render goes on: {}", error.what()));
  }
  const double took_s = std::chrono::duration<double>(Clock::now() - begin).count();
  next_ = Clock::now() + duration_of(std::max(interval_s_, took_s * (1 / most_time - 1)));
}

void CheckpointKeeper::write_last(const Film& film) {
  if (path_.empty() || film.pass_count() + film.regional_pass_count() == passes_written_) return;
  write(film);
}

bool CheckpointKeeper::is_behind(const Film& film) const {
  try {
    const PassSet there = CheckpointReader(path_, FileCheck::frame_only).film_head().passes;
    return there.count() > film.pass_count() &&
           there.common(film.passes()).count() == film.pass_count();
  } catch (const Error&) {
    // None is there, or none of use.
    return false;
  }
}

bool CheckpointKeeper::write_unless_behind(const Film& film) {
  const auto is_wanted = [&] { return !is_behind(film); };
  // Asked at once, too: what is not wanted need not be packed and brought to the disk.
  return is_wanted() &&
         write_checkpoint_if(path_, record(), film, integrator_.lessons(), is_wanted);
}

void CheckpointKeeper::write(const Film& film) {
  if (owner_ == CheckpointOwner::one) {
    write_checkpoint(path_, record(), film, integrator_.lessons());
  } else if (!write_unless_behind(film)) {
    if (!std::exchange(has_told_, true) && warn_)
      warn_(
          fmt::format("'{}' holds more passes than this render has, and stays: another process "
                      "renders them, too",
                      path_));
    return;
  }
  passes_written_ = film.pass_count() + film.regional_pass_count();
}

RenderRecord CheckpointKeeper::record() const {
  RenderRecord result = record_;
  result.seconds += std::chrono::duration<double>(Clock::now() - start_).count();
  if (result.outputs.reproducible) result.seconds = 0;
  return result;
}

}  // namespace kaustik
