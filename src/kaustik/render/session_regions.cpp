// Passes that a session gives to regions.
#include <fmt/format.h>

#include <algorithm>

#include "kaustik/render/film_memory.h"
#include "kaustik/render/session.h"
#include "kaustik/render/session_monitor.h"

namespace kaustik {

bool Session::refine(const RegionRequest& request) {
  const std::lock_guard lock(regions_mutex_);
  if (takes_regions_) ask_for(request);
  return takes_regions_;
}

void Session::ask_for(const RegionRequest& request) {
  if (request.passes < 1 || request.passes > most_region_passes)
    throw Error(ErrorKind::input, fmt::format("{} passes of a region", request.passes),
                fmt::format("ask for 1 to {} passes", most_region_passes));
  const auto same = std::find_if(regions_.begin(), regions_.end(),
                                 [&](const auto& known) { return known.pixels == request.pixels; });
  std::vector<PixelRegion> others;
  for (const RegionProgress& region : regions_) others.push_back(region.pixels);
  if (same == regions_.end()) {
    check_region(request.pixels, others, {film_.width(), film_.height()});
    others.push_back(request.pixels);
    check_region_memory(scene_.film(), film_.layers(), integrator_.traits().splats, others);
  }
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

Session::RegionWork Session::waiting_work() const {
  const std::lock_guard lock(regions_mutex_);
  RegionWork work;
  for (const RegionProgress& region : regions_)
    work.add(region.waiting, region.pixels, film_.pixel_count());
  return work;
}

bool Session::close_regions(SessionEnd end) {
  const std::lock_guard lock(regions_mutex_);
  const bool has_reached_goal = end == SessionEnd::passes || end == SessionEnd::error;
  if (has_reached_goal && can_render_regions() &&
      std::any_of(regions_.begin(), regions_.end(),
                  [](const RegionProgress& region) { return region.waiting > 0; }))
    return false;
  takes_regions_ = false;
  return true;
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
  while (can_render_regions()) {
    const auto region = next_region();
    if (!region) break;
    if (stop.stop_requested()) return PassEnd::discarded;
    if (settings_.seconds && monitor.elapsed() > *settings_.seconds) return PassEnd::discarded;
    const Pass next =
        film_.next_regional_pass(*region, film_.passes().first_missing(settings_.first_pass));
    Pass pass = pass_of(next.index);
    pass.order = next.order;
    if (render_pass({pass, region}, stop, monitor) != PassEnd::complete) return PassEnd::discarded;
    count_down(*region);
    monitor.regional_pass_done(*region, !next_region());
    if (pass_done) pass_done();
  }
  return PassEnd::complete;
}

}  // namespace kaustik
