#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "kaustik/render/job.h"
#include "picture_viewer.h"

namespace kaustik::app {

/// Looks after a running job in a thread of its own: shows its picture to viewers, and has it
/// written where SIGUSR1 asks for it. What this takes of the render's time is bounded: after a
/// snapshot there is none for twenty times as long as it took, unless it is to be written.
class PictureWatch {
 public:
  /// `write_now` writes the picture as it is, and returns whether there was one.
  PictureWatch(const Job& job, std::vector<std::unique_ptr<PictureViewer>> viewers,
               std::function<bool()> write_now);
  ~PictureWatch();

  /// What the job tells of its progress; returns at once.
  void progress(const Progress& progress);
  /// Ends the thread, once it is done with what it does.
  void stop();
  /// After stop(): shows the last picture, if there is one.
  void show_last();
  /// Gives viewers the time to take it.
  void finish_viewers();

 private:
  void work();
  bool has_news() const;
  void show_snapshot();

  const Job& job_;
  const std::vector<std::unique_ptr<PictureViewer>> viewers_;
  const std::function<bool()> write_now_;
  std::atomic<uint32_t> passes_{0};
  // Of the thread alone.
  uint32_t shown_passes_ = 0;
  bool is_write_pending_ = false;
  std::chrono::steady_clock::time_point next_snapshot_;

  std::mutex mutex_;
  std::condition_variable stopped_;
  bool is_stopped_ = false;
  std::thread thread_;
};

}  // namespace kaustik::app
