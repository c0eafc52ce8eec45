#include "kaustik/library/session_state.h"

#include <limits>

#include "kaustik/render/finished_picture.h"

namespace kaustik::v0::details {
namespace {

Stage stage_of(kaustik::Progress::Stage stage) {
  switch (stage) {
    case kaustik::Progress::Stage::light:
      return Stage::light;
    case kaustik::Progress::Stage::picture:
      return Stage::picture;
    case kaustik::Progress::Stage::done:
      break;
  }
  return Stage::idle;
}

End end_of(SessionEnd end) {
  switch (end) {
    case SessionEnd::passes:
      return End::passes;
    case SessionEnd::time:
      return End::time;
    case SessionEnd::error:
      return End::error;
    case SessionEnd::cancelled:
      break;
  }
  return End::stopped;
}

Outcome outcome_of(const JobResult& result) {
  const SessionReport& report = result.report;
  return {.end = end_of(report.end),
          .passes = report.passes,
          .samples_per_pass = report.samples_per_pass,
          .seconds = report.seconds,
          .rays = report.rays,
          .photons = report.photons,
          .relative_error = report.picture_error,
          .integrator = result.record.view.integrator};
}

}  // namespace

SessionState::SessionState(const v0::Scene& scene, const v0::SessionSettings& settings,
                           Callbacks callbacks)
    : settings_(settings), scene_(scene), callbacks_(std::move(callbacks)) {
  check_settings(settings);
  next_ = job_settings(settings, Access::scene(scene));
}

SessionState::SessionState(const v0::Scene& scene, const v0::SessionSettings& settings,
                           Callbacks callbacks, Checkpoint checkpoint, const std::string& path)
    : settings_(settings), scene_(scene), callbacks_(std::move(callbacks)) {
  check_settings(settings);
  next_ = job_settings(settings, Access::scene(scene), std::move(checkpoint), path);
  recipe_ = next_.record.recipe;
}

std::unique_lock<std::mutex> SessionState::owned() const {
  if (relay_.is_here())
    throw misuse(
        "a callback has called a function of its session that it must not call",
        "from callbacks stop(), pause(), resume(), progress() and snapshot() may be called");
  std::unique_lock lock(owner_, std::try_to_lock);
  if (!lock)
    throw misuse("another thread is in a function of this session",
                 "start, wait, run, edit, picture and save are for one thread at a time; stop() "
                 "ends the waiting");
  return lock;
}

std::shared_ptr<Job> SessionState::job() const {
  const std::lock_guard lock(mutex_);
  return job_;
}

JobListener SessionState::listener() {
  JobListener listener;
  listener.messages.note = [this](const std::string& text) {
    relay_.call(callbacks_.message, Severity::note, text);
  };
  listener.messages.warning = [this](const std::string& text) {
    relay_.call(callbacks_.message, Severity::warning, text);
  };
  listener.progress = [this](const kaustik::Progress& progress) { take(progress); };
  listener.pass_done = [this](const Film& film) {
    relay_.call(callbacks_.pass_done, film.pass_count());
  };
  return listener;
}

void SessionState::take(const kaustik::Progress& p) {
  const v0::Progress progress{.stage = stage_of(p.stage),
                              .fraction = p.fraction,
                              .elapsed_s = p.elapsed_s,
                              .remaining_s = p.remaining_s,
                              .passes_done = p.passes_done,
                              .passes_total = p.passes_total,
                              .samples_per_pixel = p.samples_per_pixel,
                              .rays_per_s = p.rays_per_s,
                              .photons_per_s = p.photons_per_s,
                              .relative_error = p.relative_error,
                              .has_picture = p.has_picture};
  {
    const std::lock_guard lock(mutex_);
    progress_ = progress;
  }
  relay_.call(callbacks_.progress, progress);
}

void SessionState::begin() {
  if (is_started_)
    throw misuse("the session was started before",
                 "make another one, or give it another scene by edit()");
  JobSettings settings = std::exchange(next_, {});
  settings.session.gate = gate_;
  settings.clock_start = std::chrono::steady_clock::now();
  auto job = std::make_shared<Job>(copy_of(Access::scene(scene_).description), std::move(settings),
                                   listener());
  failure_ = nullptr;
  result_.reset();
  const std::lock_guard lock(mutex_);
  job_ = std::move(job);
  progress_ = {.stage = Stage::building, .relative_error = std::numeric_limits<double>::infinity()};
  is_started_ = is_running_ = true;
}

void SessionState::start() {
  const auto owner = owned();
  begin_in_thread();
}

void SessionState::begin_in_thread() {
  begin();
  try {
    thread_ = std::thread([self = shared_from_this()] { self->work(); });
  } catch (...) {
    is_running_ = false;
    failure_ = std::current_exception();
    throw;
  }
}

Outcome SessionState::run() {
  const auto owner = owned();
  begin();
  work();
  return result();
}

void SessionState::work() {
  const std::shared_ptr<Job> job = this->job();
  try {
    render(*job);
  } catch (...) {
    failure_ = std::current_exception();
  }
  {
    const std::lock_guard lock(mutex_);
    progress_.stage = Stage::idle;
  }
  is_running_ = false;
}

void SessionState::render(Job& job) {
  job.prepare();
  Access::scene(scene_).built->put(job.shared_scene());
  result_ = job.run();
  if (result_->checkpoint_failure) std::rethrow_exception(result_->checkpoint_failure);
  tell_of(result_->report);
}

void SessionState::tell_of(const SessionReport& report) {
  for (const std::string& decision : report.decisions)
    relay_.call(callbacks_.message, Severity::note, decision);
  for (const std::string& warning : report.warnings)
    relay_.call(callbacks_.message, Severity::warning, warning);
}

void SessionState::join() {
  if (thread_.joinable()) thread_.join();
}

Outcome SessionState::result() {
  join();
  if (failure_) std::rethrow_exception(failure_);
  return outcome_of(*result_);
}

Outcome SessionState::wait() {
  const auto owner = owned();
  if (!is_started_) throw misuse("the session was not started", "start() it before");
  return result();
}

void SessionState::stop() {
  const std::lock_guard lock(mutex_);
  if (job_) job_->cancel();
}

void SessionState::let_go() {
  stop();
  if (!thread_.joinable()) return;
  if (relay_.is_here())
    thread_.detach();
  else
    thread_.join();
}

v0::Progress SessionState::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

std::optional<v0::Picture> SessionState::snapshot(bool with_errors) const {
  const std::shared_ptr<Job> job = this->job();
  if (!job) return std::nullopt;
  std::optional<v0::Picture> picture;
  // The film first: a pass that ends between the two is in the picture alone, not in the errors
  // alone.
  std::shared_ptr<const Film> film;
  if (with_errors)
    if (auto copy = job->film_so_far()) film = std::make_shared<const Film>(std::move(*copy));
  std::optional<Image> image = job->finished_snapshot();
  if (!image) image = job->snapshot();
  if (!image) return std::nullopt;
  const MetadataValue* passes = image->find_metadata("passes");
  const auto count = passes ? uint32_t(std::get<int64_t>(*passes)) : 0;
  return Access::picture(std::move(*image), std::move(film), count, settings_.threads);
}

void SessionState::check_ended(const char* what) const {
  if (!is_started_ || is_running_)
    throw misuse(std::string(what) + " was asked of a session that has not ended",
                 "wait() for it; snapshot() shows it before");
}

v0::Picture SessionState::picture() const {
  const auto owner = owned();
  check_ended("the picture");
  const std::shared_ptr<Job> job = this->job();
  const std::shared_ptr<const Film> film = job->shared_film();
  const bool has_passes = film && film->pass_count() > 0;
  const bool is_first_look = result_ && result_->report.end != SessionEnd::cancelled;
  std::optional<Image> image;
  if (has_passes && result_) {
    PictureFacts facts = PictureFacts::of(*film);
    facts.threads = settings_.threads;
    facts.incomplete_pass = result_->report.incomplete_pass;
    facts.part = result_->report.part;
    image = finished_picture(job->image(), result_->record, facts, {});
  } else if (has_passes) {
    image = job->finished_snapshot();
  } else if (is_first_look) {
    image = job->snapshot();
  }
  if (!image)
    throw wrong_input("there is no picture: the session has ended before every pixel had a sample",
                      "let it render longer");
  return Access::picture(std::move(*image), has_passes ? film : nullptr,
                         has_passes ? film->pass_count() : 0, settings_.threads);
}

void SessionState::edit(const v0::Scene& scene) {
  const auto owner = owned();
  if (!settings_.checkpoint.empty())
    throw misuse("the scene of a session whose passes are kept in a file can't be changed",
                 "make another session");
  stop();
  join();
  next_ = job_settings(settings_, Access::scene(scene));
  if (!next_.previous) next_.previous = Access::scene(scene_).built->get();
  if (recipe_) {
    RenderRecipe& recipe = next_.record.recipe;
    recipe.integrator = recipe_->integrator;
    recipe.camera = recipe_->camera;
    recipe.settings = recipe_->settings;
    recipe.seed = next_.session.seed = recipe_->seed;
  }
  scene_ = scene;
  if (std::exchange(is_started_, false)) begin_in_thread();
}

void SessionState::save(const std::string& path) const {
  const auto owner = owned();
  check_ended("a checkpoint");
  if (!settings_.keeps_passes && settings_.checkpoint.empty())
    throw misuse("the session keeps no passes", "set keeps_passes before it starts");
  job()->save(path);
}

}  // namespace kaustik::v0::details
