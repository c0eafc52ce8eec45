#include "kaustik/render/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "kaustik/base/bytes.h"
#include "kaustik/base/parallel.h"
#include "kaustik/base/processors.h"
#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/render/preview.h"
#include "kaustik/render/resume.h"
#include "kaustik/render/team_pace.h"
#include "kaustik/scene/part_keys.h"

namespace kaustik {
namespace {

std::string scene_name(const RenderRecipe& recipe) {
  return std::filesystem::path(recipe.scene).lexically_normal().string();
}

/// Of all that KeptLight depends on.
uint64_t light_key(const Description& description, const Scene& scene) {
  uint64_t key = hash_mix(scene.built().world, uint64_t(scene.quantity()));
  if (const auto integrator = find_integrator(description))
    key = hash_mix(key, PartKeys().whole(*integrator));
  return key;
}

/// Passes of different scenes would not belong together. Throws in all members.
void check_team(Team& team, const DescriptionDigest& digest) {
  ByteWriter own;
  own.put(digest.scene);
  own.put(digest.integrator);
  const auto digests = team.to_leader(own.take());
  ByteWriter verdict;
  uint32_t other = 0;
  for (uint32_t rank = 1; rank < digests.size() && other == 0; ++rank)
    if (digests[rank] != digests[0]) other = rank;
  verdict.put(other);
  const std::vector<uint8_t> found = team.from_leader(verdict.take());
  other = ByteReader(found, "what was found of the scene").get<uint32_t>();
  if (other > 0)
    throw Error(ErrorKind::input,
                fmt::format("process {} has another scene, or other files that it names, than "
                            "process 0",
                            other),
                "let all of them see the same files: in a folder that is shared, or in copies");
}

}  // namespace

Job::Job(Description description, JobSettings settings, JobListener listener)
    : description_(std::move(description)),
      settings_(std::move(settings)),
      listener_(std::move(listener)),
      previous_(std::move(settings_.previous)) {}

Job::~Job() {
  abandon();
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<Job::Run> Job::current() const {
  const std::lock_guard lock(mutex_);
  return run_;
}

std::shared_ptr<Job::Run> Job::current_with_session() const {
  const std::lock_guard lock(mutex_);
  return run_ && run_->session ? run_ : nullptr;
}

std::shared_ptr<Job::Run> Job::prepared_run() {
  if (auto run = current()) return run;
  if (settings_.begun && settings_.learned)
    throw std::logic_error("Job: passes that go on have their lessons; others can't be given");
  if (settings_.task != JobTask::render && (settings_.begun || settings_.learned))
    throw std::logic_error("Job: only a render goes on, or has lessons given");
  apply_changes(description_, settings_.record.recipe, listener_.messages,
                settings_.integrator_origin);
  const auto run = std::make_shared<Run>();
  const bool needs_digest = settings_.task == JobTask::learn || settings_.keeps_digest ||
                            keeps_passes() || settings_.begun || settings_.learned;
  with_threads(settings_.session.threads, [&] {
    if (settings_.task == JobTask::trace_photons)
      run->prepared.scene =
          build_scene_and_tell(description_, settings_.build, listener_.messages, previous_);
    else
      run->prepared =
          prepare_scene(description_, settings_.build, needs_digest, listener_.messages, previous_);
    previous_ = nullptr;
    if (settings_.begun) check_same_scene(run->prepared, *settings_.begun, settings_.begun_path);
    teach(run->prepared);
  });
  if (settings_.session.team) check_team(*settings_.session.team, *run->prepared.digest);
  if (settings_.keeps_light && run->prepared.integrator) {
    run->light_key = light_key(description_, *run->prepared.scene);
    const bool is_same = settings_.light.key == run->light_key;
    run->prepared.integrator->keep_light(is_same ? settings_.light.light : nullptr);
    settings_.light = {};
  }
  const std::lock_guard lock(mutex_);
  run_ = run;
  return run;
}

void Job::prepare() {
  if (is_started_) throw std::logic_error("Job::prepare: the job was started before");
  prepared_run();
}

void Job::begin(JobTask task, const char* function) {
  if (settings_.task != task)
    throw std::logic_error(std::string("Job::") + function + ": the job's task is another");
  if (std::exchange(is_started_, true))
    throw std::logic_error(std::string("Job::") + function + ": the job was started before");
}

void Job::start() {
  begin(JobTask::render, "start");
  thread_ = std::thread([this] { work(); });
}

const JobResult& Job::run() {
  begin(JobTask::render, "run");
  work();
  return wait();
}

const JobResult& Job::wait() {
  if (!is_started_) throw std::logic_error("Job::wait: the job was not started");
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  return result_;
}

void Job::cancel() {
  const std::lock_guard lock(mutex_);
  stop_.request_stop();
}

void Job::abandon() {
  const std::lock_guard lock(mutex_);
  is_abandoned_ = true;
  if (run_ && run_->session) run_->session->abandon_pass();
  stop_.request_stop();
}

Learned Job::learn(const ProgressFunction& progress) {
  begin(JobTask::learn, "learn");
  const SessionSettings& session = settings_.session;
  LearningSettings settings;
  settings.seed = session.seed;
  settings.passes = session.passes.value_or(settings.passes);
  settings.samples_per_pass = session.samples_per_pass;
  settings.threads = session.threads;
  const std::shared_ptr<Run> run = prepared_run();
  Learned learned = kaustik::learn(run->prepared, settings, stop_.get_token(), progress);
  learned.stored.program = settings_.record.program;
  learned.stored.scene = scene_name(settings_.record.recipe);
  return learned;
}

TracedPhotons Job::trace_photons(const PhotonPart& part, const ProgressFunction& progress) {
  begin(JobTask::trace_photons, "trace_photons");
  const SessionSettings& session = settings_.session;
  const std::shared_ptr<Run> run = prepared_run();
  TracedPhotons traced = trace_photon_maps(description_, *run->prepared.scene, session.seed,
                                           session.threads, stop_.get_token(), progress, part);
  traced.photons.scene = scene_name(settings_.record.recipe);
  return traced;
}

void Job::work() {
  try {
    render();
  } catch (...) {
    failure_ = std::current_exception();
  }
  if (listener_.ended) listener_.ended(failure_);
}

void Job::teach(const PreparedScene& prepared) const {
  if (const auto& begun = settings_.begun) {
    const LessonUse use = begun->record.recipe.lessons != 0 ? LessonUse::fixed : LessonUse::go_on;
    if (!begun->lessons.empty()) hand_over(begun->lessons, use, settings_.begun_path, prepared);
  } else if (const auto& learned = settings_.learned) {
    check_same_scene(prepared, *learned, settings_.learned_path);
    hand_over(learned->lessons, LessonUse::fixed, settings_.learned_path, prepared);
  }
}

void Job::make_session(Run& run) {
  SessionSettings settings = settings_.session;
  settings.keeps_passes = keeps_passes();
  if (!settings_.checkpoint.empty()) settings.team_interval_s = settings_.every_s;
  if (settings_.learned && !settings.samples_per_pass &&
      !(settings.passes && settings.samples_per_pixel))
    settings.samples_per_pass = settings_.learned->samples_per_pass;
  if (settings.seconds) {
    // What it took to read the scene is of the time that there is.
    constexpr double least_s = 1e-3;
    const std::chrono::duration<double> gone =
        std::chrono::steady_clock::now() - settings_.clock_start;
    settings.seconds = std::max(least_s, *settings.seconds - gone.count());
  }
  const PreparedScene& prepared = run.prepared;
  // What it has begun with is the leader's.
  auto session = settings_.begun && !is_follower()
                     ? std::make_unique<Session>(*prepared.scene, *prepared.integrator, settings,
                                                 std::move(settings_.begun->film))
                     : std::make_unique<Session>(*prepared.scene, *prepared.integrator, settings);
  if (settings_.begun) check_same_passes(*session, *settings_.begun, settings_.begun_path);
  settings_.begun.reset();
  RenderRecord& record = result_.record;
  record = settings_.record;
  record.instruction_sets.insert(instruction_set());
  record.recipe.samples_per_pass = session->samples_per_pass();
  if (settings_.learned) record.recipe.lessons = digest_of(settings_.learned->lessons);
  if (prepared.digest) record.recipe.digest = *prepared.digest;
  record.plan.first_pass = session->first_pass();
  record.plan.passes = session->planned_passes();
  if (settings.part) record.plan.division = session->division();
  record.view = prepared.view;
  const std::lock_guard lock(mutex_);
  run.record = record;
  run.begin = std::chrono::steady_clock::now();
  run.rested_s = rested_s();
  // It may have been asked for before there was a session.
  if (is_abandoned_) session->abandon_pass();
  run.session = std::move(session);
}

bool Job::begins_with_light(const Run& run) const {
  const IntegratorType* type = find_integrator_type(run.prepared.view.integrator);
  const bool has_light = run.prepared.integrator->kept_light() != nullptr;
  return !settings_.begun && !has_light && !(type && type->is_from_camera_alone);
}

void Job::make_preview(Run& run) {
  if (run.preview) return;
  std::shared_ptr<const Image> preview;
  with_threads(settings_.session.threads, [&] {
    preview = std::make_shared<const Image>(
        preview_picture(*run.prepared.scene, settings_.session.seed, stop_.get_token()));
  });
  const std::lock_guard lock(mutex_);
  run.preview = std::move(preview);
}

void Job::render() {
  const std::shared_ptr<Run> run = prepared_run();
  if (settings_.previews && begins_with_light(*run)) make_preview(*run);
  make_session(*run);
  const std::string checkpoint = is_follower() ? "" : settings_.checkpoint;
  const bool keeps = !checkpoint.empty();
  // Else a film that was added up would often come too early for a checkpoint.
  const double every_s =
      settings_.session.team ? soon_enough * settings_.every_s : settings_.every_s;
  CheckpointKeeper keeper(checkpoint, settings_.owner, every_s, result_.record,
                          *run->prepared.integrator, listener_.messages.warning);
  Session& session = *run->session;
  result_.report = session.run(stop_.get_token(), listener_.progress, [&] {
    keeper.pass_done(session.film());
    if (listener_.pass_done) listener_.pass_done(session.film());
  });
  const SessionReport& report = result_.report;
  result_.record.seconds += report.seconds;
  if (is_follower()) return;
  if (report.passes == 0 && !report.cancelled() && !session.has_picture()) {
    make_preview(*run);
    if (stop_.stop_requested()) result_.report.end = SessionEnd::cancelled;
  }
  if (!keeps || report.passes == 0) return;
  if (report.incomplete_pass)
    return listener_.messages.warn("no pass was finished: there is no checkpoint");
  // A failure must not cost the picture.
  try {
    keeper.write_last(session.film());
  } catch (...) {
    result_.checkpoint_failure = std::current_exception();
  }
}

std::optional<Image> Job::snapshot(bool with_layers) const {
  std::unique_lock lock(mutex_);
  const std::shared_ptr<Run> run = run_;
  if (!run) return std::nullopt;
  const Session* session = run->session.get();
  const std::shared_ptr<const Image> preview = run->preview;
  lock.unlock();
  std::optional<Image> picture = session ? session->snapshot(nullptr, with_layers) : std::nullopt;
  if (!picture && preview) picture = *preview;
  return picture;
}

double Job::rested_s() const {
  return settings_.session.gate ? settings_.session.gate->closed_s() : 0;
}

bool Job::refine(const RegionRequest& request) {
  const std::shared_ptr<Run> run = current_with_session();
  if (!run)
    throw Error(ErrorKind::input, "there is no picture yet whose regions could have more passes",
                "ask again when it has begun");
  return run->session->refine(request);
}

std::vector<RegionProgress> Job::regions() const {
  const std::shared_ptr<Run> run = current_with_session();
  return run ? run->session->regions() : std::vector<RegionProgress>();
}

bool Job::look_at_film(const std::function<void(const Film&)>& look) const {
  std::unique_lock lock(mutex_);
  const std::shared_ptr<Run> run = run_;
  if (!run || !run->session) return false;
  lock.unlock();
  return run->session->look_at_film(look);
}

std::optional<Image> Job::finished_snapshot(const Messages& messages) const {
  std::unique_lock lock(mutex_);
  const std::shared_ptr<Run> run = run_;
  if (!run || !run->session) return std::nullopt;
  RenderRecord record = run->record;
  const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - run->begin;
  const double seconds = gone.count() - (rested_s() - run->rested_s);
  lock.unlock();
  SnapshotFacts shown;
  std::optional<Image> picture = run->session->snapshot(&shown);
  if (!picture) return std::nullopt;
  record.seconds += seconds;
  return finished_picture(std::move(*picture), record,
                          {.passes = shown.passes,
                           .samples_per_pixel = shown.samples_per_pixel,
                           .threads = settings_.session.threads},
                          messages);
}

void Job::edit(Description description) {
  if (!settings_.checkpoint.empty())
    throw std::logic_error("Job::edit: its passes are kept in a checkpoint");
  abandon();
  if (thread_.joinable()) thread_.join();
  {
    const std::lock_guard lock(mutex_);
    if (run_) previous_ = run_->prepared.scene;
    run_ = nullptr;
    stop_ = {};
    is_abandoned_ = false;
  }
  description_ = std::move(description);
  settings_.begun.reset();
  settings_.learned.reset();
  settings_.clock_start = std::chrono::steady_clock::now();
  result_ = {};
  failure_ = nullptr;
  if (std::exchange(is_started_, false) && settings_.task == JobTask::render) start();
}

const Scene& Job::scene() const { return *current()->prepared.scene; }

std::shared_ptr<const Scene> Job::shared_scene() const {
  const std::shared_ptr<Run> run = current();
  return run ? run->prepared.scene : nullptr;
}

JobLight Job::kept_light() const {
  const std::shared_ptr<Run> run = current();
  return {run->light_key, run->prepared.integrator->kept_light()};
}

std::optional<Film> Job::film_so_far() const {
  std::unique_lock lock(mutex_);
  const std::shared_ptr<Run> run = run_;
  if (!run || !run->session) return std::nullopt;
  lock.unlock();
  return run->session->film_so_far();
}

const Film& Job::film() const { return current()->session->film(); }

std::shared_ptr<const Film> Job::shared_film() const {
  const std::shared_ptr<Run> run = current();
  if (!run || !run->session) return nullptr;
  return {run, &run->session->film()};
}

void Job::save(const std::string& path) const {
  if (!keeps_passes()) throw std::logic_error("Job::save: the job keeps no passes");
  const std::shared_ptr<Run> run = current();
  if (!run || !run->session || run->session->film().pass_count() == 0 ||
      result_.report.incomplete_pass)
    throw Error(ErrorKind::input, "no pass is finished, so there is nothing to keep",
                "let it render longer");
  write_checkpoint(path, result_.record, run->session->film(), run->prepared.integrator->lessons());
}

Image Job::image() const { return current()->session->image(); }

PictureFacts Job::picture_facts() const {
  PictureFacts facts = PictureFacts::of(film());
  facts.threads = settings_.session.threads;
  facts.incomplete_pass = result_.report.incomplete_pass;
  facts.part = result_.report.part;
  return facts;
}

Image Job::finished_image(const Messages& messages) const {
  return finished_picture(image(), result_.record, picture_facts(), messages);
}

Checkpoint Job::checkpoint() const {
  const std::shared_ptr<Run> run = current();
  if (!run || !run->session || !run->prepared.digest)
    throw std::logic_error("Job::checkpoint: the digest of its scene was not asked for");
  if (result_.report.passes == 0 || result_.report.incomplete_pass)
    throw Error(ErrorKind::input, "no pass was finished, so there is nothing to go on with",
                "give it more time, or passes with fewer samples");
  return {result_.record, run->session->film(), run->prepared.integrator->lessons()};
}

}  // namespace kaustik
