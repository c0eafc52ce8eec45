#include "kaustik/live/engine.h"

#include <stdexcept>
#include <utility>

namespace kaustik {

Engine::Engine(EngineSettings settings, Messages messages)
    : settings_(std::move(settings)), messages_(std::move(messages)), thread_([this] { work(); }) {}

Engine::~Engine() {
  {
    const std::lock_guard lock(mutex_);
    wanted_.ends = true;
  }
  changed_.notify_all();
  thread_.join();
}

uint64_t Engine::edit(Description description) {
  const std::lock_guard lock(mutex_);
  wanted_.description = std::make_shared<const Description>(std::move(description));
  changed_.notify_all();
  return ++wanted_.revision;
}

void Engine::start() {
  const std::lock_guard lock(mutex_);
  if (!wanted_.description) throw std::logic_error("Engine::start: there is no description");
  wanted_.runs = true;
  ++wanted_.start;
  changed_.notify_all();
}

void Engine::stop() {
  const std::lock_guard lock(mutex_);
  wanted_.runs = false;
  changed_.notify_all();
}

void Engine::pause() {
  const std::lock_guard lock(mutex_);
  wanted_.is_paused = true;
  if (gate_) gate_->close();
  if (status_.state == EngineState::rendering) status_.state = EngineState::paused;
  changed_.notify_all();
}

void Engine::resume() {
  const std::lock_guard lock(mutex_);
  wanted_.is_paused = false;
  if (gate_) gate_->open();
  if (status_.state == EngineState::paused) status_.state = EngineState::rendering;
  changed_.notify_all();
}

EngineStatus Engine::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::shared_ptr<const Snapshot> Engine::snapshot() const {
  const std::lock_guard lock(mutex_);
  return snapshot_;
}

std::shared_ptr<const Snapshot> Engine::wait_for_snapshot(uint64_t after,
                                                          std::chrono::milliseconds most) const {
  std::unique_lock lock(mutex_);
  const bool is_there =
      changed_.wait_for(lock, most, [&] { return snapshot_ && snapshot_->number > after; });
  return is_there ? snapshot_ : nullptr;
}

bool Engine::wait_until_done(std::chrono::milliseconds most) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, most, [&] {
    const EngineState state = status_.state;
    return !is_busy_ && !has_work() && state != EngineState::building &&
           state != EngineState::rendering && state != EngineState::paused;
  });
}

bool Engine::has_work() const {
  if (!wanted_.runs) return shown_ != nullptr;
  return taken_revision_ != wanted_.revision || taken_start_ != wanted_.start;
}

void Engine::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return wanted_.ends || has_work(); });
    if (wanted_.ends) break;
    const Wanted wanted = wanted_;
    taken_revision_ = wanted.revision;
    taken_start_ = wanted.start;
    is_busy_ = true;
    lock.unlock();
    take(wanted);
    lock.lock();
    is_busy_ = false;
    changed_.notify_all();
  }
  lock.unlock();
  end_run();
}

void Engine::take(const Wanted& wanted) {
  if (!wanted.runs) {
    end_run();
    const std::lock_guard lock(mutex_);
    status_.state = EngineState::idle;
    return;
  }
  EngineState before;
  {
    const std::lock_guard lock(mutex_);
    before = std::exchange(status_.state, EngineState::building);
    // All cores are for the new scene.
    if (gate_) gate_->close();
  }
  std::unique_ptr<Run> run;
  try {
    run = prepared(wanted);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    status_.failure = std::current_exception();
    if (gate_ && !wanted_.is_paused) gate_->open();
    // The run before may have ended meanwhile.
    if (status_.state == EngineState::building) status_.state = state_after_refusal(before);
    changed_.notify_all();
    return;
  }
  end_run();
  begin(std::move(run));
}

EngineState Engine::state_after_refusal(EngineState before) const {
  if (!shown_) return EngineState::failed;
  if (before == EngineState::finished || before == EngineState::failed) return before;
  return wanted_.is_paused ? EngineState::paused : EngineState::rendering;
}

std::unique_ptr<Engine::Run> Engine::prepared(const Wanted& wanted) {
  auto run = std::make_unique<Run>();
  run->revision = wanted.revision;
  run->gate = std::make_shared<Gate>();
  JobSettings settings;
  settings.record.recipe = settings_.recipe;
  settings.session = settings_.session;
  settings.session.gate = run->gate;
  settings.build = settings_.build;
  settings.previews = true;
  if (run_) settings.previous = run_->job->shared_scene();
  const Run& of = *run;
  JobListener listener;
  listener.messages = messages_;
  listener.progress = [this, &of](const Progress& progress) { progressed(of, progress); };
  listener.pass_done = [this, &of](const Film& film) { pass_done(of, film.pass_count()); };
  listener.ended = [this, &of](const std::exception_ptr& failure) { ended(of, failure); };
  run->job = std::make_unique<Job>(*wanted.description, std::move(settings), std::move(listener));
  run->job->prepare();
  return run;
}

void Engine::begin(std::unique_ptr<Run> run) {
  run_ = std::move(run);
  {
    const std::lock_guard lock(mutex_);
    shown_ = run_.get();
    gate_ = run_->gate;
    if (wanted_.is_paused) gate_->close();
    status_.state = wanted_.is_paused ? EngineState::paused : EngineState::rendering;
    status_.revision = run_->revision;
    status_.progress = {};
    status_.failure = nullptr;
    changed_.notify_all();
  }
  run_->job->start();
}

void Engine::end_run() {
  if (!run_) return;
  {
    const std::lock_guard lock(mutex_);
    shown_ = nullptr;
    gate_ = nullptr;
  }
  run_->job->cancel();
  try {
    run_->job->wait();
  } catch (...) {
    // ended() has told.
  }
  run_ = nullptr;
}

void Engine::progressed(const Run& run, const Progress& progress) {
  {
    const std::lock_guard lock(mutex_);
    if (shown_ != &run) return;
    status_.progress = progress;
    changed_.notify_all();
  }
  publish(run, false);
}

void Engine::pass_done(const Run& run, uint32_t passes) {
  {
    const std::lock_guard lock(mutex_);
    if (shown_ != &run) return;
    status_.progress.passes_done = passes;
    status_.progress.has_picture = true;
  }
  publish(run, false);
}

void Engine::ended(const Run& run, const std::exception_ptr& failure) {
  if (!failure) publish(run, true);
  const std::lock_guard lock(mutex_);
  if (shown_ != &run) return;
  status_.failure = failure;
  status_.state = failure ? EngineState::failed : EngineState::finished;
  changed_.notify_all();
}

void Engine::publish(const Run& run, bool is_last) {
  using Clock = std::chrono::steady_clock;
  Snapshot::Kind kind;
  uint32_t passes;
  double elapsed_s;
  {
    const std::lock_guard lock(mutex_);
    if (shown_ != &run) return;
    const Progress& progress = status_.progress;
    passes = progress.passes_done;
    elapsed_s = progress.elapsed_s;
    kind = passes > 0             ? Snapshot::Kind::passes
           : progress.has_picture ? Snapshot::Kind::samples
                                  : Snapshot::Kind::preview;
    const bool is_like_last =
        snapshot_ && snapshot_->revision == run.revision && snapshot_->kind == kind;
    const std::chrono::duration<double> since = Clock::now() - published_;
    if (is_like_last && !is_last &&
        (kind == Snapshot::Kind::preview || since.count() < settings_.snapshot_interval_s))
      return;
  }
  std::optional<Image> picture = run.job->snapshot();
  if (!picture) return;
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->revision = run.revision;
  snapshot->kind = kind;
  snapshot->passes = passes;
  snapshot->elapsed_s = elapsed_s;
  snapshot->picture = std::move(*picture);
  const std::lock_guard lock(mutex_);
  if (shown_ != &run) return;
  snapshot->number = snapshot_ ? snapshot_->number + 1 : 1;
  snapshot_ = std::move(snapshot);
  published_ = Clock::now();
  changed_.notify_all();
}

}  // namespace kaustik
