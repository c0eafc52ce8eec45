#include "kaustik/live/engine.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kaustik {
namespace {

/// How long a view that moves is waited for at most until it shows its light.
constexpr std::chrono::seconds longest_wait(10);

}  // namespace

RenderRecipe recipe_of_moving_views() {
  RenderRecipe recipe;
  recipe.integrator = "photonmap";
  // Enough photons to see shapes by.
  for (const char* setting : {"integrator.gather=false", "integrator.global_neighbors=40"})
    recipe.settings.push_back(setting_from(setting, "a view whose camera moves"));
  return recipe;
}

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

uint64_t Engine::edit(const Description& description) {
  auto copy = std::make_shared<const Description>(copy_of(description));
  const std::lock_guard lock(mutex_);
  wanted_.description.swap(copy);
  touched_ = Clock::now();
  changed_.notify_all();
  return ++wanted_.revision;
}

void Engine::start() {
  const std::lock_guard lock(mutex_);
  if (!wanted_.description) throw std::logic_error("Engine::start: there is no description");
  const bool is_over =
      status_.state == EngineState::finished || status_.state == EngineState::failed;
  if (wanted_.runs && is_over && !is_building_) ++wanted_.starts;
  if (!wanted_.runs) touched_ = Clock::now();
  wanted_.runs = true;
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
  changed_.notify_all();
}

void Engine::resume() {
  const std::lock_guard lock(mutex_);
  wanted_.is_paused = false;
  if (gate_ && !is_building_) gate_->open();
  changed_.notify_all();
}

EngineState Engine::state() const {
  if (is_building_) return EngineState::building;
  if (status_.state == EngineState::rendering && wanted_.is_paused) return EngineState::paused;
  return status_.state;
}

std::shared_ptr<Job> Engine::resting_job() const {
  const std::lock_guard lock(mutex_);
  const bool rests = shown_ && !shown_->is_moving;
  const bool will_change = taken_.revision != wanted_.revision || is_building_;
  return rests && !will_change && status_.state == EngineState::rendering ? shown_job_ : nullptr;
}

bool Engine::can_refine() const { return resting_job() != nullptr; }

void Engine::refine(const RegionRequest& request) {
  const auto job = resting_job();
  if (!job || !job->refine(request))
    throw Error(ErrorKind::input,
                "there is no picture at rest that is rendered, so no region can have more passes",
                "start the render, and ask when its first pass is shown");
}

EngineStatus Engine::status() const {
  std::unique_lock lock(mutex_);
  EngineStatus status = status_;
  status.state = state();
  const auto job = shown_job_;
  lock.unlock();
  if (job) status.regions = job->regions();
  return status;
}

std::shared_ptr<const Snapshot> Engine::snapshot() const {
  const std::lock_guard lock(mutex_);
  return snapshot_;
}

std::shared_ptr<const Snapshot> Engine::wait_for_snapshot(uint64_t after,
                                                          std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  const bool is_there =
      changed_.wait_for(lock, timeout, [&] { return snapshot_ && snapshot_->number > after; });
  return is_there ? snapshot_ : nullptr;
}

std::shared_ptr<const Job> Engine::shown_job() const {
  const std::lock_guard lock(mutex_);
  return shown_job_;
}

bool Engine::look_at_film(const std::function<void(const Film&)>& look) const {
  const auto job = shown_job();
  return job && job->look_at_film(look);
}

std::optional<Image> Engine::finished_snapshot(const Messages& messages) const {
  const auto job = shown_job();
  return job ? job->finished_snapshot(messages) : std::nullopt;
}

std::shared_ptr<const Scene> Engine::scene() const {
  const auto job = shown_job();
  return job ? job->shared_scene() : nullptr;
}

bool Engine::wait_until_done(std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [&] {
    const bool will_rest = taken_.is_moving && taken_.runs;
    return !is_busy_ && !has_work() && !will_rest && !is_building_ &&
           status_.state != EngineState::rendering;
  });
}

Engine::Clock::time_point Engine::end_of_motion() const {
  constexpr double longest = 1e6;
  const std::chrono::duration<double> rest(std::clamp(settings_.rest_s, 0.0, longest));
  return touched_ + std::chrono::duration_cast<Clock::duration>(rest);
}

Engine::Clock::time_point Engine::longest_motion() const {
  return std::max(end_of_motion(), touched_ + longest_wait);
}

bool Engine::moves() const { return settings_.moving && Clock::now() < end_of_motion(); }

bool Engine::rests() const {
  if (!taken_.is_moving || wanted_.is_paused || moves()) return false;
  // Light that is not traced to its end is lost, and the next move would begin anew. And until the
  // first pass at rest is done its picture is looked at: it should have all its pixels.
  const bool has_pass = snapshot_ && snapshot_->kind == Snapshot::Kind::passes;
  return (has_pass && shows_motion(taken_.revision)) || status_.state != EngineState::rendering ||
         Clock::now() >= longest_motion();
}

bool Engine::shows_motion(uint64_t revision) const {
  return snapshot_ && snapshot_->revision == revision && snapshot_->is_moving &&
         snapshot_->kind != Snapshot::Kind::preview;
}

bool Engine::has_work() const {
  if (taken_.runs != wanted_.runs) return true;
  if (!wanted_.runs) return false;
  return rests() || taken_.revision != wanted_.revision || taken_.starts != wanted_.starts;
}

void Engine::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    const auto is_asked = [&] { return wanted_.ends || has_work(); };
    if (taken_.is_moving && taken_.runs && !wanted_.is_paused)
      changed_.wait_until(lock, moves() ? end_of_motion() : longest_motion(), is_asked);
    else
      changed_.wait(lock, is_asked);
    let_show(lock);
    if (wanted_.ends) break;
    if (!has_work()) continue;
    // Every edit moves, however late it is taken.
    const bool is_edited = taken_.revision != wanted_.revision;
    taken_ = wanted_;
    taken_.is_moving = is_edited ? settings_.moving && settings_.rest_s > 0 : moves();
    is_busy_ = true;
    const Wanted wanted = taken_;
    lock.unlock();
    take(wanted);
    lock.lock();
    is_busy_ = false;
    changed_.notify_all();
  }
  lock.unlock();
  end_run();
}

void Engine::let_show(std::unique_lock<std::mutex>& lock) {
  // Of views that move there is something to be seen after a round of samples, however long that
  // takes.
  const std::chrono::milliseconds longest(taken_.is_moving ? 1000 : 100);
  changed_.wait_for(lock, longest, [&] {
    const bool has_shown = snapshot_ && snapshot_->revision == status_.revision;
    return wanted_.ends || !wanted_.runs || wanted_.is_paused || has_shown ||
           status_.state != EngineState::rendering;
  });
}

void Engine::take(const Wanted& wanted) {
  if (!wanted.runs) {
    end_run();
    const std::lock_guard lock(mutex_);
    status_.state = EngineState::idle;
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    is_building_ = true;
    // All cores are for the new scene.
    if (gate_) gate_->close();
  }
  std::unique_ptr<Run> run;
  std::exception_ptr refusal;
  try {
    run = prepared(wanted);
  } catch (...) {
    refusal = std::current_exception();
  }
  bool is_wanted;
  {
    const std::lock_guard lock(mutex_);
    is_building_ = false;
    is_wanted = run && wanted_.runs && !wanted_.ends;
    if (refusal) {
      status_.refusal = refusal;
      status_.refused_revision = wanted.revision;
      if (!shown_) status_.state = EngineState::failed;
    }
    if (!is_wanted && gate_ && !wanted_.is_paused) gate_->open();
    changed_.notify_all();
  }
  if (!is_wanted) return;
  end_run();
  begin(std::move(run));
}

std::unique_ptr<Engine::Run> Engine::prepared(const Wanted& wanted) {
  auto run = std::make_unique<Run>();
  run->revision = wanted.revision;
  run->is_moving = wanted.is_moving;
  run->gate = std::make_shared<Gate>();
  JobSettings settings;
  settings.record.recipe = wanted.is_moving ? *settings_.moving : settings_.recipe;
  settings.session = settings_.session;
  settings.session.gate = run->gate;
  if (run->is_moving) settings.session.layers = false;
  settings.build = settings_.build;
  {
    const std::lock_guard lock(mutex_);
    settings.previews = !shows_motion(wanted.revision);
  }
  settings.previous = run_ ? run_->job->shared_scene() : last_scene_;
  settings.keeps_light = true;
  take_light();
  settings.light = light_[wanted.is_moving ? 1 : 0];
  const Run& of = *run;
  JobListener listener;
  listener.messages = messages_;
  listener.progress = [this, &of](const Progress& progress) { progressed(of, progress); };
  listener.pass_done = [this, &of](const Film& film) { pass_done(of, film.pass_count()); };
  listener.ended = [this, &of](const std::exception_ptr& failure) { ended(of, failure); };
  run->job =
      std::make_shared<Job>(copy_of(*wanted.description), std::move(settings), std::move(listener));
  run->job->prepare();
  return run;
}

void Engine::begin(std::unique_ptr<Run> run) {
  run_ = std::move(run);
  {
    const std::lock_guard lock(mutex_);
    shown_ = run_.get();
    shown_job_ = run_->job;
    gate_ = run_->gate;
    if (wanted_.is_paused) gate_->close();
    // What took long to build has its time, too.
    if (run_->is_moving) touched_ = Clock::now();
    status_ = {};
    status_.state = EngineState::rendering;
    status_.revision = run_->revision;
    changed_.notify_all();
  }
  try {
    run_->job->start();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    shown_ = nullptr;
    shown_job_ = nullptr;
    gate_ = nullptr;
    status_.state = EngineState::failed;
    status_.failure = std::current_exception();
    changed_.notify_all();
  }
}

void Engine::end_run() {
  if (!run_) return;
  {
    const std::lock_guard lock(mutex_);
    shown_ = nullptr;
    shown_job_ = nullptr;
    gate_ = nullptr;
  }
  take_light();
  run_->job->abandon();
  try {
    run_->job->wait();
  } catch (...) {
    // ended() has told.
  }
  last_scene_ = run_->job->shared_scene();
  run_ = nullptr;
}

void Engine::take_light() {
  if (!run_) return;
  if (JobLight kept = run_->job->kept_light(); kept.light)
    light_[run_->is_moving ? 1 : 0] = std::move(kept);
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
  std::exception_ptr why = failure;
  try {
    if (!failure) publish(run, true);
  } catch (...) {
    why = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  if (shown_ != &run) return;
  status_.failure = why;
  status_.state = why ? EngineState::failed : EngineState::finished;
  changed_.notify_all();
}

void Engine::publish(const Run& run, bool is_last) {
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
    if (!run.is_moving && shows_motion(run.revision) && kind != Snapshot::Kind::passes && !is_last)
      return;
    const bool is_like_last =
        snapshot_ && snapshot_->revision == run.revision && snapshot_->kind == kind;
    const std::chrono::duration<double> since = Clock::now() - published_;
    if (is_like_last && !is_last &&
        (kind == Snapshot::Kind::preview || since.count() < settings_.snapshot_interval_s))
      return;
  }
  std::optional<Image> picture = run.job->snapshot(settings_.layers_in_snapshots);
  if (!picture) return;
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->revision = run.revision;
  snapshot->kind = kind;
  snapshot->is_moving = run.is_moving;
  snapshot->passes = passes;
  snapshot->elapsed_s = elapsed_s;
  snapshot->scene = run.job->shared_scene();
  snapshot->picture = std::move(*picture);
  const std::lock_guard lock(mutex_);
  if (shown_ != &run) return;
  snapshot->number = snapshot_ ? snapshot_->number + 1 : 1;
  snapshot_ = std::move(snapshot);
  published_ = Clock::now();
  changed_.notify_all();
}

}  // namespace kaustik
