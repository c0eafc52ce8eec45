#include "kaustik/live/watched_jobs.h"

#include <thread>
#include <utility>

#include "kaustik/render/film.h"

namespace kaustik {
namespace {

using Clock = std::chrono::steady_clock;
/// Between two looks for something new, and between two pictures of the same kind.
constexpr std::chrono::milliseconds look_interval(50), snapshot_interval(100);

/// That are finished.
struct FilmPasses {
  uint32_t whole = 0, regional = 0;
};
FilmPasses passes_of(const Job& job) {
  FilmPasses passes;
  job.look_at_film([&](const Film& film) {
    passes = {film.pass_count(), film.regional_pass_count()};
  });
  return passes;
}

}  // namespace

uint64_t WatchedJobs::show(std::shared_ptr<const Job> job, std::function<JobCourse()> course) {
  Shown next{std::move(job), std::move(course), 0};
  const std::lock_guard lock(mutex_);
  next.revision = shown_.revision + 1;
  // Who holds the job before may end it by letting go: not under the lock.
  std::swap(shown_, next);
  return shown_.revision;
}

WatchedJobs::Shown WatchedJobs::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

EngineStatus WatchedJobs::status() const {
  const Shown shown = this->shown();
  EngineStatus status;
  status.revision = shown.revision;
  if (!shown.job) return status;
  const JobCourse course = shown.course();
  status.progress = course.progress;
  status.regions = shown.job->regions();
  status.failure = course.failure;
  status.state = course.failure              ? EngineState::failed
                 : course.has_ended          ? EngineState::finished
                 : course.is_paused          ? EngineState::paused
                 : shown.job->shared_scene() ? EngineState::rendering
                                             : EngineState::building;
  return status;
}

std::shared_ptr<const Snapshot> WatchedJobs::snapshot() const {
  const std::lock_guard lock(mutex_);
  return snapshot_;
}

bool WatchedJobs::is_due(const Shown& shown, Snapshot::Kind kind, uint32_t passes,
                         bool has_ended) const {
  const std::lock_guard lock(mutex_);
  if (!snapshot_ || snapshot_->revision != shown.revision || snapshot_->kind != kind) return true;
  if (is_last_) return false;
  if (has_ended) return true;
  if (kind == Snapshot::Kind::preview || Clock::now() - made_ < snapshot_interval) return false;
  return kind == Snapshot::Kind::samples || passes_ != passes;
}

void WatchedJobs::look(const Shown& shown) const {
  if (!shown.job) return;
  // Of several who wait one makes the picture, so that none replaces a newer one.
  const std::unique_lock making(making_, std::try_to_lock);
  if (!making) return;
  // Asked before the picture is made, so that nothing after it is missed.
  const JobCourse course = shown.course();
  const FilmPasses film = passes_of(*shown.job);
  const uint32_t passes = film.whole + film.regional;
  const Snapshot::Kind kind = film.whole > 0                ? Snapshot::Kind::passes
                              : course.progress.has_picture ? Snapshot::Kind::samples
                                                            : Snapshot::Kind::preview;
  if (!is_due(shown, kind, passes, course.has_ended)) return;
  std::optional<Image> picture = shown.job->snapshot(false);
  if (!picture) return;
  auto next = std::make_shared<Snapshot>();
  next->revision = shown.revision;
  next->kind = kind;
  next->passes = film.whole;
  next->elapsed_s = course.progress.elapsed_s;
  next->scene = shown.job->shared_scene();
  next->picture = std::move(*picture);
  const std::lock_guard lock(mutex_);
  if (shown_.revision != shown.revision) return;
  next->number = snapshot_ ? snapshot_->number + 1 : 1;
  snapshot_ = std::move(next);
  passes_ = passes;
  is_last_ = course.has_ended;
  made_ = Clock::now();
}

std::shared_ptr<const Snapshot> WatchedJobs::wait_for_snapshot(
    uint64_t after, std::chrono::milliseconds timeout) const {
  const auto deadline = Clock::now() + timeout;
  while (true) {
    look(shown());
    if (auto latest = snapshot(); latest && latest->number > after) return latest;
    if (Clock::now() >= deadline) return nullptr;
    std::this_thread::sleep_for(look_interval);
  }
}

bool WatchedJobs::look_at_film(const std::function<void(const Film&)>& look) const {
  const Shown shown = this->shown();
  return shown.job && shown.job->look_at_film(look);
}

std::optional<Image> WatchedJobs::finished_snapshot() const {
  const Shown shown = this->shown();
  return shown.job ? shown.job->finished_snapshot() : std::nullopt;
}

std::shared_ptr<const Scene> WatchedJobs::scene() const {
  const Shown shown = this->shown();
  return shown.job ? shown.job->shared_scene() : nullptr;
}

}  // namespace kaustik
