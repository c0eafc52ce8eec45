#include "events.h"

#include <unistd.h>

#include <cmath>

#include "exit_codes.h"
#include "kaustik/base/version.h"
#include "screen.h"
#include "signals.h"

namespace kaustik::app {
namespace {

using Need = EventStream::Need;

JsonObject event_of(const char* kind) { return JsonObject().add("event", kind); }

/// To so many places behind the point: more would be noise.
double rounded(double value, int places) {
  const double scale = std::pow(10.0, places);
  return std::round(value * scale) / scale;
}

void add_seconds(JsonObject& event, const char* name, double seconds) {
  if (seconds >= 0)
    event.add(name, rounded(seconds, 3));
  else
    event.add_null(name);
}

}  // namespace

Events& events() {
  static Events only;
  return only;
}

void Events::begin(std::unique_ptr<EventStream> stream, const std::string& command,
                   const std::string& scene) {
  *this = Events();
  stream_ = std::move(stream);
  is_on_screen_ = stream_->is_same_as(STDERR_FILENO);
  if (is_on_screen_)
    screen().hand_messages_to([this](Level level, const std::string& text) {
      stream_->send(event_of("message").add("level", level_name(level)).add("text", text),
                    Need::lasting);
    });
  stream_->send(event_of("start")
                    .add("version", KAUSTIK_VERSION)
                    .add("command", command)
                    .add("scene", scene)
                    .add("process", int64_t(::getpid())),
                Need::lasting);
}

void Events::progress(const Progress& p) {
  if (!stream_) return;
  const bool is_done = p.stage == Progress::Stage::done;
  const bool is_new = p.passes_done != passes_told_;
  if (!is_done && !is_new && p.elapsed_s - last_told_s_ < 1) return;
  last_told_s_ = p.elapsed_s;
  passes_told_ = p.passes_done;
  JsonObject event = event_of("progress");
  event.add("pass", p.passes_done);
  if (p.passes_total > 0)
    event.add("passes", p.passes_total);
  else
    event.add_null("passes");
  event.add("samples_per_pixel", p.samples_per_pixel).add("fraction", rounded(p.fraction, 4));
  add_seconds(event, "elapsed_s", p.elapsed_s);
  add_seconds(event, "remaining_s", is_done ? 0 : p.remaining_s);
  event.add("error", p.relative_error)
      .add("rays_per_s", std::round(p.rays_per_s))
      .add("photons_per_s", std::round(p.photons_per_s))
      .add("memory_bytes", uint64_t(p.memory_bytes));
  stream_->send(event, is_done ? Need::lasting : Need::passing);
}

void Events::progress(double fraction, double elapsed_s) {
  if (!stream_ || elapsed_s - last_told_s_ < 1) return;
  last_told_s_ = elapsed_s;
  JsonObject event = event_of("progress");
  event.add("fraction", rounded(fraction, 4));
  add_seconds(event, "elapsed_s", elapsed_s);
  add_seconds(event, "remaining_s", fraction > 1e-3 ? elapsed_s * (1 / fraction - 1) : -1);
  stream_->send(event, Need::passing);
}

void Events::written(const std::string& file, const JsonObject& facts) {
  if (stream_) stream_->send(event_of("written").add("file", file).append(facts), Need::lasting);
}

void Events::measured(const JsonObject& facts) {
  if (stream_) stream_->send(event_of("measured").append(facts), Need::lasting);
}

void Events::result(const std::string& reason, const JsonObject& facts) {
  reason_ = reason;
  facts_ = facts;
}

void Events::end(int exit_code, const std::string& message) {
  if (!stream_) return;
  const bool is_early = exit_code == exit_ended_early;
  JsonObject event = event_of("end");
  event.add("reason", is_early ? "signal" : exit_code != 0 ? "failed" : reason_);
  event.add("exit_code", exit_code);
  if (is_early) event.add("signal", first_signal_name());
  if (!message.empty()) event.add("message", message);
  stream_->send(event.append(facts_), Need::lasting);
  screen().hand_messages_to({});
  stream_.reset();
}

}  // namespace kaustik::app
