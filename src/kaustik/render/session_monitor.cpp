#include "kaustik/render/session_monitor.h"

#include <unistd.h>

#include <cmath>
#include <fstream>

namespace kaustik {
namespace {

/// Resident memory of the program, 0 where the system does not tell.
size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  size_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * size_t(sysconf(_SC_PAGESIZE));
}

}  // namespace

void Session::Monitor::tell(Progress::Stage stage, bool force) {
  if (!listener_) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || (!force && told_ && seconds_since(last_) < 0.2)) return;
  told_ = true;
  last_ = now();
  Progress p;
  p.stage = stage;
  p.elapsed_s = elapsed();
  p.passes_done = passes_at_start_ + passes_done_;
  p.passes_total = session_.pass_count_ == 0 ? 0 : passes_at_start_ + passes_to_do_;
  p.samples_per_pixel = session_.film_.samples_per_pixel();
  p.fraction = stage == Progress::Stage::done ? 1 : fraction(p.elapsed_s);
  p.remaining_s = p.fraction > 1e-3 ? p.elapsed_s * (1 / p.fraction - 1) : -1;
  p.rays_per_s = double(rays) / std::max(1e-9, p.elapsed_s);
  p.photons_per_s = light_seconds > 0 ? double(photons) / light_seconds : 0;
  p.memory_bytes = resident_bytes();
  p.relative_error = error_;
  p.has_picture = session_.has_picture_;
  listener_(p);
}

double Session::Monitor::passes_for_error() const {
  const double passes = passes_at_start_ + passes_done_;
  const double needed = passes * std::pow(error_ / *session_.settings_.error, 2);
  return std::exp2(std::ceil(std::log2(std::max(double(replicate_count), needed))));
}

double Session::Monitor::fraction(double elapsed_s) const {
  double f = 0;
  if (session_.pass_count_ > 0) {
    const double pixels = double(pixels_of_pass_);
    const double samples = std::max(1.0, pixels * session_.samples_per_pass_);
    RegionWork pass{light_done_, 0};
    pass.camera = std::min(1.0, double(samples_done_) / samples) * pixels /
                  double(session_.film_.pixel_count());
    const double done = passes_done_ + passes_in(regions_done_);
    const double all =
        passes_to_do_ + passes_in(regions_done_) + passes_in(session_.waiting_work());
    // The others of a team are about as far.
    const uint32_t at_a_time = session_.settings_.team ? session_.settings_.team->size() : 1;
    if (all > 0) f = (done + at_a_time * passes_in(pass)) / all;
  }
  if (session_.settings_.error)
    f = std::max(f, (passes_at_start_ + passes_done_) / passes_for_error());
  if (session_.settings_.seconds) f = std::max(f, elapsed_s / *session_.settings_.seconds);
  return std::min(f, 0.999);
}

}  // namespace kaustik
