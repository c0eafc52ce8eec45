#pragma once
#include <mutex>

#include "kaustik/live/watched.h"

namespace kaustik {

/// What the owner of a job knows of its course.
struct JobCourse {
  Progress progress;
  bool is_paused = false;
  bool has_ended = false;
  std::exception_ptr failure;  ///< what ended it otherwise than it should; null: nothing
};

/// A job that its owner runs, one after the other: those who watch see what it renders, and nothing
/// is rendered for them. Pictures are made by who waits for them.
class WatchedJobs final : public Watched {
 public:
  /// From now on this is what is seen; null: nothing is. `course` is called from any thread, as
  /// long as the job is kept. Returns the revision, from 1 on.
  uint64_t show(std::shared_ptr<const Job> job, std::function<JobCourse()> course);

  EngineStatus status() const override;
  std::shared_ptr<const Snapshot> snapshot() const override;
  std::shared_ptr<const Snapshot> wait_for_snapshot(
      uint64_t after, std::chrono::milliseconds timeout) const override;
  bool look_at_film(const std::function<void(const Film&)>& look) const override;
  std::optional<Image> finished_snapshot() const override;
  std::shared_ptr<const Scene> scene() const override;

 private:
  struct Shown {
    std::shared_ptr<const Job> job;
    std::function<JobCourse()> course;
    uint64_t revision = 0;
  };
  Shown shown() const;
  /// Makes the next snapshot if there is anything new to be seen.
  void look(const Shown& shown) const;
  bool is_due(const Shown& shown, Snapshot::Kind kind, uint32_t passes, bool has_ended) const;

  mutable std::mutex making_;  ///< taken before the other one
  mutable std::mutex mutex_;   ///< of what follows
  Shown shown_;
  mutable std::shared_ptr<const Snapshot> snapshot_;
  mutable uint32_t passes_ = 0;   ///< in it, those of regions too
  mutable bool is_last_ = false;  ///< the snapshot was made after the job's end
  mutable std::chrono::steady_clock::time_point made_;
};

}  // namespace kaustik
