#pragma once
// For the session's own sources.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

#include "kaustik/render/session.h"

namespace kaustik {

/// Passes of regions, and what their samples come to.
struct Session::RegionWork {
  double passes = 0;
  double camera = 0;  ///< in visualisation passes of the whole picture

  void add(double count, const PixelRegion& region, size_t pixels_of_picture) {
    passes += count;
    camera += count * double(region.pixel_count()) / double(pixels_of_picture);
  }
};

/// Counts what is done and tells the listener now and then.
class Session::Monitor {
 public:
  Monitor(const Session& session, const std::function<void(const Progress&)>& listener)
      : session_(session),
        listener_(listener),
        start_(now()),
        passes_at_start_(session.film_.pass_count()),
        passes_to_do_(session.film_.passes().missing(session.planned())),
        light_share_(session.integrator_.traits().samples_camera ? 0.3 : 1),
        error_(session.film_.picture_error()) {}

  void start_pass(const std::optional<PixelRegion>& region) {
    pass_start_ = now();
    pixels_of_pass_ = region ? uint64_t(region->pixel_count()) : session_.film_.pixel_count();
    samples_done_ = 0;
    light_done_ = 0;
  }
  void light_pass_at(double share) {
    light_done_ = share;
    tell(Progress::Stage::light, false);
  }
  /// What regional passes take tells nothing of those of the picture.
  void light_pass_done(const PassReport& report, bool is_regional) {
    const double seconds = seconds_since(pass_start_);
    if (!is_regional) last_light_seconds_ = seconds;
    light_seconds += seconds;
    light_done_ = 1;
    if (passes_done_ == 0 && light_seconds < 0.1) light_share_ = 0;
    rays += report.rays;
    photons += report.photons;
    tell(Progress::Stage::picture, false);
  }
  void samples_done(uint64_t samples, uint64_t sample_rays) {
    rays += sample_rays;
    samples_done_ += samples;
    tell(Progress::Stage::picture, false);
  }
  void pass_done() {
    last_pass_seconds_ = seconds_since(pass_start_);
    ++passes_done_;
    samples_done_ = 0;
    light_done_ = 0;
    light_share_ = std::min(1.0, light_seconds / std::max(1e-9, elapsed()));
    // Those who abandon it want no error.
    if (!session_.is_pass_abandoned_ && !session_.settings_.team) find_error();
    tell(Progress::Stage::light, false);
  }
  /// Their passes may take less time than finding out the error of a large picture does, so that is
  /// done now and then, and after the last one that was asked for.
  void regional_pass_done(const PixelRegion& region, bool is_last) {
    regions_done_.add(1, region, session_.film_.pixel_count());
    samples_done_ = 0;
    light_done_ = 0;
    if (is_last || now() - last_error_ > 1) {
      error_ = session_.film_.picture_error();
      last_error_ = now();
    }
    tell(Progress::Stage::light, is_last);
  }
  /// Of other members of the team.
  void others_done(uint32_t passes) { passes_done_ += passes; }
  void find_error() { error_ = session_.film_.picture_error(); }
  uint32_t passes_done() const { return passes_done_; }
  double error() const { return error_; }
  double now() const {
    const SessionSettings& settings = session_.settings_;
    const double now =
        settings.clock
            ? settings.clock()
            : std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
                  .count();
    return settings.gate ? now - settings.gate->closed_s() : now;
  }
  double seconds_since(double start) const { return now() - start; }
  double elapsed() const { return seconds_since(start_); }
  /// Of the last pass: the first may hold plans that are made once, the mean would too.
  double last_pass_seconds() const { return last_pass_seconds_; }
  /// Of the next pass until each pixel has a sample, if it is like the last one. That may have been
  /// the first, whose light pass makes plans: then the next one's may take a fraction of its time.
  /// To try it costs nothing, for it is halted where it comes too late.
  double least_pass_seconds() const {
    constexpr double least_fraction = 0.25;
    const double camera = last_pass_seconds_ - last_light_seconds_;
    return (passes_done() - passes_at_start_ > 1 ? 1 : least_fraction) * last_light_seconds_ +
           (session_.integrator_.traits().samples_camera
                ? camera / std::max(1u, session_.samples_per_pass_)
                : camera);
  }

  /// Tells the listener if it is time, or if `force`.
  void tell(Progress::Stage stage, bool force);

  std::atomic<uint64_t> rays{0}, photons{0}, dropped{0};
  double light_seconds = 0;

 private:
  /// How many it will take if the error falls with the square root of their number; infinite: not
  /// known yet.
  double passes_for_error() const;
  double fraction(double elapsed_s) const;
  /// In passes of the picture, for which light and camera take these shares of the time.
  double passes_in(const RegionWork& work) const {
    return light_share_ * work.passes + (1 - light_share_) * work.camera;
  }

  const Session& session_;
  const std::function<void(const Progress&)>& listener_;
  double start_, pass_start_ = 0, last_ = 0, last_error_ = 0;  ///< s
  double last_pass_seconds_ = 0, last_light_seconds_ = 0;
  bool told_ = false;
  std::mutex mutex_;
  uint32_t passes_at_start_;
  uint32_t passes_to_do_;    ///< 0: limited by time, or nothing is left
  RegionWork regions_done_;  ///< by this session
  uint64_t pixels_of_pass_ = 0;
  std::atomic<uint32_t> passes_done_{0};   ///< of this session
  std::atomic<uint64_t> samples_done_{0};  ///< of this pass, of all pixels
  std::atomic<double> light_done_{0};      ///< of this pass's light pass
  std::atomic<double> light_share_;        ///< of a pass's time; a guess before the first is done
  std::atomic<double> error_;              ///< of the picture
};

}  // namespace kaustik
