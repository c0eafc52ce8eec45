#include "picture_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "screen.h"
#include "signals.h"

namespace kaustik::app {
namespace {

constexpr std::chrono::milliseconds look_again(50);
constexpr int rest_per_snapshot = 20;

}  // namespace

PictureWatch::PictureWatch(const Job& job, std::vector<std::unique_ptr<PictureViewer>> viewers,
                           std::function<bool()> write_now)
    : job_(job), viewers_(std::move(viewers)), write_now_(std::move(write_now)) {
  thread_ = std::thread([this] { work(); });
}

PictureWatch::~PictureWatch() { stop(); }

void PictureWatch::progress(const Progress& progress) { passes_ = progress.passes_done; }

void PictureWatch::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }
  stopped_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PictureWatch::work() {
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, look_again, [&] { return is_stopped_; })) {
    lock.unlock();
    try {
      if (take_picture_request()) is_write_pending_ = true;
      if (is_write_pending_ && write_now_()) is_write_pending_ = false;
      if (has_news()) show_snapshot();
    } catch (const std::exception& error) {
      // The render is worth more than a look at it.
      warn(fmt::format("cannot show the picture as it is now: {}", error.what()));
      is_write_pending_ = false;
    }
    lock.lock();
  }
}

bool PictureWatch::has_news() const {
  // In the first pass samples come all the time.
  const bool is_new = passes_ == 0 || passes_ != shown_passes_;
  return is_new && std::chrono::steady_clock::now() >= next_snapshot_ &&
         std::any_of(viewers_.begin(), viewers_.end(),
                     [](const auto& viewer) { return viewer->is_ready(); });
}

void PictureWatch::show_snapshot() {
  const auto start = std::chrono::steady_clock::now();
  const uint32_t passes = passes_;
  if (const std::optional<Image> image = job_.snapshot()) {
    shown_passes_ = passes;
    for (const auto& viewer : viewers_)
      if (viewer->is_ready()) viewer->show(*image);
  }
  const auto end = std::chrono::steady_clock::now();
  next_snapshot_ = end + rest_per_snapshot * (end - start);
}

void PictureWatch::show_last() {
  if (viewers_.empty()) return;
  if (const std::optional<Image> image = job_.snapshot())
    for (const auto& viewer : viewers_) viewer->show(*image);
}

void PictureWatch::finish_viewers() {
  for (const auto& viewer : viewers_) viewer->finish();
}

}  // namespace kaustik::app
