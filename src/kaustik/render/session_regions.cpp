// Passes that a session gives to regions.
#include <fmt/format.h>

#include <algorithm>

#include "kaustik/render/session.h"
#include "kaustik/render/session_monitor.h"

namespace kaustik {

void Session::refine(const RegionRequest& request) {
  if (request.passes < 1 || request.passes > most_region_passes)
    throw Error(ErrorKind::input, fmt::format("{} passes of a region", request.passes),
                fmt::format("ask for 1 to {} passes", most_region_passes));
  const std::lock_guard lock(regions_mutex_);
  const auto same = std::find_if(regions_.begin(), regions_.end(),
                                 [&](const auto& known) { return known.pixels == request.pixels; });
  std::vector<PixelRegion> others;
  for (const RegionProgress& region : regions_) others.push_back(region.pixels);
  if (same == regions_.end()) check_region(request.pixels, others, {film_.width(), film_.height()});
  RegionProgress& region =
      same != regions_.end() ? *same : regions_.emplace_back(RegionProgress{request.pixels});
  if (region.waiting > most_region_passes - request.passes)
    throw Error(ErrorKind::input,
                fmt::format("{} passes of this region are waited for already", region.waiting),
                "ask for more when they are finished");
  region.waiting += request.passes;
}

std::vector<RegionProgress> Session::regions() const {
  const std::lock_guard lock(regions_mutex_);
  return regions_;
}

std::optional<PixelRegion> Session::next_region() const {
  const std::lock_guard lock(regions_mutex_);
  const auto next = std::find_if(regions_.begin(), regions_.end(),
                                 [](const RegionProgress& region) { return region.waiting > 0; });
  return next == regions_.end() ? std::nullopt : std::optional(next->pixels);
}

void Session::count_down(const PixelRegion& region) {
  const std::lock_guard lock(regions_mutex_);
  for (RegionProgress& known : regions_)
    if (known.pixels == region) {
      ++known.passes;
      --known.waiting;
    }
}

Session::PassEnd Session::render_regions(std::stop_token stop, Monitor& monitor,
                                         const std::function<void()>& pass_done) {
  // Its plans are those of the next pass of the picture, and errors need one of it.
  while (film_.pass_count() > 0 && !report_.incomplete_pass) {
    const auto region = next_region();
    if (!region) break;
    if (stop.stop_requested()) return PassEnd::discarded;
    if (settings_.seconds && monitor.elapsed() > *settings_.seconds) return PassEnd::discarded;
    Pass pass =
        film_.next_regional_pass(*region, film_.passes().first_missing(settings_.first_pass));
    pass.seed = settings_.seed;
    pass.samples_per_pixel = samples_per_pass_;
    if (render_pass({pass, region}, stop, monitor) != PassEnd::complete) return PassEnd::discarded;
    count_down(*region);
    monitor.regional_pass_done(!next_region());
    if (pass_done) pass_done();
  }
  return PassEnd::complete;
}

}  // namespace kaustik
