#include "kaustik/render/session_team.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "kaustik/base/parallel.h"
#include "kaustik/render/film_reduction.h"

namespace kaustik {
namespace {

/// In a round, so that its lists stay short.
constexpr uint64_t most_passes_per_member = 1024;
/// The same while passes teach: that is kept until the end of the round.
constexpr uint64_t most_taught_per_member = 4;
/// Adding up takes no more than this share of the time.
constexpr double most_adding = 0.05;
constexpr uint32_t never = std::numeric_limits<uint32_t>::max();

}  // namespace

Session::TeamRun::TeamRun(Session& session, Monitor& monitor, std::stop_token stop,
                          const std::function<void()>& pass_done)
    : session_(session),
      monitor_(monitor),
      stop_(std::move(stop)),
      pass_done_(pass_done),
      team_(*session.settings_.team),
      lessons_(session.integrator_.share_lessons()),
      pace_(team_.size()),
      rendered_(session.film_.passes()),
      last_s_(monitor.now()) {}

SessionEnd Session::TeamRun::run() {
  while (true) {
    const TeamOrder order = TeamOrder::from(
        team_.from_leader(team_.is_led_here() ? next_order().bytes() : std::vector<uint8_t>()));
    switch (order.kind) {
      case TeamOrder::Kind::render:
        take_reports(team_.to_leader(rendered(order).bytes()));
        break;
      case TeamOrder::Kind::add_up:
        add_up();
        break;
      case TeamOrder::Kind::end:
        return order.end;
    }
  }
}

TeamReport Session::TeamRun::rendered(const TeamOrder& order) {
  if (lessons_ && !order.lessons.empty() && !team_.is_led_here())
    lessons_->take_over(order.lessons);
  TeamReport report;
  const uint64_t rays = monitor_.rays, photons = monitor_.photons, dropped = monitor_.dropped;
  for (const uint32_t index : order.of_member(team_.rank())) {
    const double begin = monitor_.now();
    const Pass pass = session_.pass_of(index);
    if (stop_.stop_requested() ||
        session_.render_pass({pass, {}}, stop_, monitor_) != PassEnd::complete)
      break;
    monitor_.pass_done();
    report.seconds += monitor_.seconds_since(begin);
    report.passes.push_back(
        {index, lessons_ ? lessons_->take_taught(index) : std::vector<uint8_t>()});
  }
  report.is_stopped = stop_.stop_requested();
  report.rays = monitor_.rays - rays;
  report.photons = monitor_.photons - photons;
  report.dropped = monitor_.dropped - dropped;
  return report;
}

void Session::TeamRun::take_reports(const std::vector<std::vector<uint8_t>>& reports) {
  if (!team_.is_led_here()) return;
  std::vector<TeamReport::DonePass> done;
  for (uint32_t rank = 0; rank < reports.size(); ++rank) {
    TeamReport report = TeamReport::from(reports[rank]);
    is_stopped_ = is_stopped_ || report.is_stopped;
    const auto passes = uint32_t(report.passes.size());
    pace_.add(rank, passes, report.seconds);
    if (rank > 0) {
      elsewhere_ += passes;
      monitor_.others_done(passes);
      monitor_.rays += report.rays;
      monitor_.photons += report.photons;
      monitor_.dropped += report.dropped;
    }
    std::ranges::move(report.passes, std::back_inserter(done));
  }
  pace_.round_done(monitor_.seconds_since(round_begin_s_));
  std::ranges::sort(done, {}, &TeamReport::DonePass::pass);
  for (const TeamReport::DonePass& of_pass : done) {
    rendered_.add({of_pass.pass, of_pass.pass + 1});
    if (lessons_) lessons_->add_taught(session_.pass_of(of_pass.pass), of_pass.taught);
  }
  if (elsewhere_ == 0 && !done.empty()) film_is_whole();
}

void Session::TeamRun::film_is_whole() {
  monitor_.find_error();
  if (pass_done_) pass_done_();
}

void Session::TeamRun::add_up() {
  const double begin = monitor_.now();
  {
    const std::lock_guard lock(session_.picture_mutex_);
    isolated([&] { add_films(team_, session_.film_); });
    session_.has_picture_ = session_.film_.pass_count() > 0;
  }
  if (!team_.is_led_here()) return;
  elsewhere_ = 0;
  film_is_whole();
  last_s_ = monitor_.now();
  took_s_ = last_s_ - begin;
}

double Session::TeamRun::time_to_add_up() const {
  if (!session_.settings_.team_interval_s) return std::numeric_limits<double>::infinity();
  return std::max(*session_.settings_.team_interval_s, took_s_ * (1 / most_adding - 1));
}

bool Session::TeamRun::is_time_to_add_up() const {
  return monitor_.seconds_since(last_s_) >= soon_enough * time_to_add_up();
}

uint32_t Session::TeamRun::next_look(uint32_t passes) {
  return std::bit_ceil(std::max(passes + 1, replicate_count));
}

std::optional<SessionEnd> Session::TeamRun::end_before(uint32_t first) const {
  // Of some passes the error tells nothing that one process would know.
  if (elsewhere_ == 0 && session_.is_good_enough(monitor_.error())) return SessionEnd::error;
  if (session_.pass_count_ > 0 && first >= session_.planned().end) return SessionEnd::passes;
  const std::optional<double> seconds = session_.settings_.seconds;
  if (seconds && monitor_.passes_done() > 0 &&
      monitor_.elapsed() + pace_.fastest_pass_s() > *seconds)
    return SessionEnd::time;
  return std::nullopt;
}

TeamOrder Session::TeamRun::next_order() {
  const uint32_t first = rendered_.first_missing(session_.settings_.first_pass);
  std::optional<SessionEnd> end = end_before(first);
  if (!end && (is_stopped_ || stop_.stop_requested())) end = SessionEnd::cancelled;
  const bool looks = session_.settings_.error && rendered_.count() >= replicate_count &&
                     std::has_single_bit(rendered_.count());
  if (elsewhere_ > 0 && (end || looks || is_time_to_add_up()))
    return {TeamOrder::Kind::add_up, {}, {}, {}, {}};
  if (end) return {TeamOrder::Kind::end, *end, {}, {}, {}};
  TeamOrder round = next_round(first);
  // It may have been stopped while passes were traced for their lessons.
  if (stop_.stop_requested()) return next_order();
  return round;
}

double Session::TeamRun::next_round_s() const {
  const double pass_s = pace_.usual_pass_s();
  double seconds = pace_.next_round_s(shortest_round_s, longest_round_s);
  if (session_.settings_.team_interval_s)
    seconds =
        std::min(seconds, std::max(pass_s, time_to_add_up() - monitor_.seconds_since(last_s_)));
  // A pass that is begun is finished, so the last one begins a pass before.
  if (const std::optional<double> limit = session_.settings_.seconds)
    seconds = std::min(seconds, *limit - monitor_.elapsed() - 0.5 * pass_s);
  return std::max(seconds, 0.0);
}

TeamOrder Session::TeamRun::next_round(uint32_t first) {
  TeamOrder order{TeamOrder::Kind::render, {}, {}, {}, {}};
  if (lessons_ && first >= lessons_end_) {
    PassReport report;
    order.lessons = lessons_->lessons_for(
        session_.pass_of(first), stop_, [&](double share) { monitor_.light_pass_at(share); },
        report);
    monitor_.rays += report.rays;
    monitor_.photons += report.photons;
    lessons_end_ = lessons_->epoch_end(first).value_or(never);
  }
  const bool is_learning = lessons_ && lessons_end_ != never;
  uint64_t most = team_.size() * (is_learning ? most_taught_per_member : most_passes_per_member);
  if (session_.settings_.error)
    most = std::min<uint64_t>(most, next_look(rendered_.count()) - rendered_.count());
  const uint32_t end = std::min(is_learning ? lessons_end_ : pass_limit,
                                session_.pass_count_ > 0 ? session_.planned().end : pass_limit);
  most = std::min<uint64_t>(most, rendered_.missing({first, end}));
  round_begin_s_ = monitor_.now();
  const std::optional<double> limit = session_.settings_.seconds;
  const double rest_s = limit ? *limit - monitor_.elapsed() : longest_round_s;
  order.shares = pace_.shares(most, next_round_s(), std::min(rest_s, longest_round_s));
  most = std::accumulate(order.shares.begin(), order.shares.end(), uint64_t{0});
  for (uint32_t pass = first; pass < end && order.passes.count() < most;
       pass = rendered_.first_missing(pass + 1))
    order.passes.add({pass, pass + 1});
  return order;
}

}  // namespace kaustik
