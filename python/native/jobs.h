#pragma once
// What views see of the renders of sessions.

#include <memory>

#include "kaustik/live/watched_jobs.h"

namespace kaustik::python {

/// A render in threads of its own; Python's `Job`. What is here may be called from any thread, and
/// calls no Python.
class LiveJob {
 public:
  LiveJob() = default;
  virtual ~LiveJob() = default;
  LiveJob(const LiveJob&) = delete;
  LiveJob& operator=(const LiveJob&) = delete;

  virtual const Job& job() const = 0;
  virtual JobCourse course() const = 0;
  virtual void pause() = 0;
  virtual void resume() = 0;
  virtual void request_stop() = 0;
  /// False: it renders nothing, or has come to its end.
  virtual bool refine(const RegionRequest& request) = 0;
};

}  // namespace kaustik::python
