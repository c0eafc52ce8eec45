#include "benchmarks/comparisons/snapshots.h"

#include <sys/resource.h>
#include <atomic>
#include <limits>

#include "kaustik/render/part_picture.h"

namespace kaustik::bench {
namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Image colors_of(const Image& image) {
  const std::vector<std::string> names = {"R", "G", "B"};
  Image result(image.width(), image.height(), names);
  for (int c = 0; c < int(names.size()); ++c) {
    const int channel = image.find_channel(names[size_t(c)]);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) result.at(x, y, c) = image.at(x, y, channel);
  }
  return result;
}

/// Looks at the film of a session between its passes, when it is time to; during the first pass, at
/// its samples so far.
class Photographer {
 public:
  Photographer(const Session& session, const std::vector<double>& times, const Image& reference)
      : session_(session), times_(times), reference_(reference) {
    result_.samples_per_pass = session.samples_per_pass();
  }

  /// Time of rendering, without that of looking.
  double elapsed() const { return seconds_since(start_) - looking_seconds_; }
  bool is_over() const { return elapsed() > times_.back(); }

  /// During a pass; called from one thread at a time.
  void progressed() {
    const size_t next = result_.pictures.size();
    if (next >= times_.size() || last_pass_end_ > 0 || elapsed() < times_[next]) return;
    const std::optional<Image> so_far = session_.snapshot();
    result_.pictures.emplace_back();
    if (so_far && !so_far->find_metadata(incomplete_key)) look_at(*so_far, 0);
    result_.pictures.back() = latest_;
  }

  void pass_done() {
    const double now = elapsed();
    const double pass_seconds = now - last_pass_end_;
    last_pass_end_ = now;
    // This pass has ended after these times, so what was seen before it is what counts for them.
    keep_until(now);
    if (result_.pictures.size() == times_.size()) return;
    // The next pass may end after the next time. Passes that suddenly take far longer than the one
    // before leave the older picture, never one that came too late.
    if (now + 4 * pass_seconds >= times_[result_.pictures.size()]) look();
  }

  Snapshots result() {
    keep_until(std::numeric_limits<double>::infinity());
    return result_;
  }

 private:
  void keep_until(double time) {
    while (result_.pictures.size() < times_.size() && times_[result_.pictures.size()] < time)
      result_.pictures.push_back(latest_);
  }
  void look() {
    const auto begin = std::chrono::steady_clock::now();
    look_at(session_.film().image(), session_.film().pass_count());
    looking_seconds_ = looking_seconds_ + seconds_since(begin);
  }
  void look_at(const Image& image, uint32_t passes) {
    latest_ = compare_images(image, reference_);
    result_.last = colors_of(image);
    result_.passes = passes;
  }

  const Session& session_;
  const std::vector<double>& times_;
  const Image& reference_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<double> looking_seconds_ = 0;  ///< threads at work read it
  double last_pass_end_ = 0;
  std::optional<ImageComparison> latest_;
  Snapshots result_;
};

}  // namespace

Snapshots render_with_snapshots(const Scene& scene, const Integrator& integrator,
                                const SessionSettings& settings, const std::vector<double>& times,
                                const Image& reference) {
  SessionSettings endless = settings;
  endless.seconds = std::numeric_limits<double>::infinity();
  Session session(scene, integrator, endless);
  std::stop_source stop;
  const double cpu_before = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  const double threads = std::max(1, settings.threads);
  Photographer photographer(session, times, reference);
  const auto stop_in_time = [&](const Progress&) {
    photographer.progressed();
    if (photographer.is_over()) stop.request_stop();
  };
  session.run(stop.get_token(), stop_in_time, [&] { photographer.pass_done(); });
  Snapshots result = photographer.result();
  result.cpu_share = (cpu_seconds() - cpu_before) / (seconds_since(start) * threads);
  return result;
}

}  // namespace kaustik::bench
