#include "benchmarks/cluster/team_run.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>

namespace kaustik::bench {
namespace {

/// Passes that teach: epochs of 1, 1, 2, 4, … 128.
constexpr uint64_t taught_passes = 256;
/// As in render/session_team.cpp.
constexpr uint64_t most_taught_per_node = 4;
/// As in apps/mpi/mpi_team.cpp.
constexpr double piece_gb = 262144e-9;

}  // namespace

TeamRun::TeamRun(const Machines& machines, uint32_t nodes, bool broadcasts, uint64_t seed)
    : machines_(machines),
      nodes_(nodes),
      broadcasts_(broadcasts),
      random_(seed),
      speed_(nodes, 1),
      pace_(nodes),
      passes_(uint64_t(std::llround(nodes * machines.job_s / machines.pass_s))),
      left_(passes_),
      safe_left_(passes_) {
  std::bernoulli_distribution is_slow(machines.slow_share);
  for (double& speed : speed_)
    if (is_slow(random_)) speed = machines.slow_speed;
  time_.ideal_s = double(passes_) * machines.pass_s / nodes;
  fail();
}

JobTime TeamRun::run() {
  while (!(begin() && learn() && render())) {
    // All since the last time is lost, and what it took.
    const double lost_s = double(safe_left_ - left_) * machines_.pass_s / nodes_;
    time_.lost_s[size_t(Loss::failures)] += lost_s + machines_.requeue_s;
    time_.seconds += machines_.requeue_s;
    left_ = safe_left_;
    fail();
  }
  return time_;
}

/// Draws when the next node fails.
void TeamRun::fail() {
  failure_s_ = time_.seconds +
               std::exponential_distribution<double>(nodes_ / machines_.mean_life_s)(random_);
}

bool TeamRun::spend(double seconds, Loss loss) {
  const double spent_s = std::min(seconds, failure_s_ - time_.seconds);
  time_.seconds += spent_s;
  time_.lost_s[size_t(loss)] += spent_s;
  return spent_s == seconds;
}

double TeamRun::broadcast_s(double gigabytes) const {
  return gigabytes / machines_.link_gb_s + std::log2(double(nodes_)) * machines_.message_s;
}

bool TeamRun::begin() {
  const double levels = std::log2(double(nodes_));
  const double load_s =
      broadcasts_ ? machines_.scene_gb / machines_.server_gb_s + broadcast_s(machines_.scene_gb)
                  : nodes_ * machines_.scene_gb / machines_.server_gb_s;
  const bool is_there =
      spend(machines_.launch_s + levels * machines_.launch_level_s, Loss::launch) &&
      spend(load_s + machines_.build_s, Loss::load);
  added_up_s_ = time_.seconds;
  return is_there;
}

bool TeamRun::learn() {
  if (machines_.learned) return true;
  // What a checkpoint has, it has learned.
  for (uint64_t first = passes_ - left_; first < std::min(taught_passes, passes_);
       first = passes_ - left_) {
    const uint64_t epoch = std::min(first == 0 ? 1 : std::bit_floor(first), left_);
    for (uint64_t done = 0; done < epoch;) {
      const uint64_t most = std::min(epoch - done, nodes_ * most_taught_per_node);
      const double seconds = pace_.next_round_s(shortest_round_s, longest_round_s);
      const uint64_t passes = round(most, seconds, Loss::learning);
      if (passes == 0) return false;
      done += passes;
    }
    const double lessons_s = double(epoch) * machines_.lesson_gb / machines_.link_gb_s;
    if (!spend(lessons_s + broadcast_s(machines_.lesson_gb), Loss::learning)) return false;
  }
  return true;
}

bool TeamRun::render() {
  while (left_ > 0) {
    const double usual_s = pace_.usual_pass_s();
    const double until_s = machines_.interval_s - (time_.seconds - added_up_s_);
    const double seconds =
        std::min(pace_.next_round_s(shortest_round_s, longest_round_s), std::max(usual_s, until_s));
    if (round(left_, seconds, Loss::rounds) == 0) return false;
    if ((left_ == 0 || time_.seconds - added_up_s_ >= soon_enough * machines_.interval_s) &&
        !add_up())
      return false;
  }
  return true;
}

double TeamRun::pass_s(uint32_t node) {
  // Of the mean 1.
  const double variance = std::log1p(machines_.pass_spread * machines_.pass_spread);
  std::lognormal_distribution<double> spread(-0.5 * variance, std::sqrt(variance));
  return machines_.pass_s / speed_[node] * spread(random_);
}

uint64_t TeamRun::round(uint64_t most, double seconds, Loss loss) {
  struct Event {
    double s;
    uint32_t node;
    bool operator<(const Event& other) const { return s > other.s; }
  };
  const std::vector<uint32_t> shares = pace_.shares(most, seconds, longest_round_s);
  std::vector<uint32_t> to_do = shares;
  std::priority_queue<Event> events;
  const double begin_s = time_.seconds, order_s = broadcast_s(4e-9 * nodes_);
  for (uint32_t node = 0; node < nodes_; ++node)
    if (to_do[node] > 0) events.push({begin_s + order_s + pass_s(node), node});
  uint64_t passes = 0;
  double last_s = begin_s;
  while (!events.empty() && events.top().s < failure_s_) {
    const auto [s, node] = events.top();
    events.pop();
    ++passes;
    last_s = s;
    if (--to_do[node] > 0)
      events.push({s + pass_s(node), node});
    else
      pace_.add(node, shares[node], s - begin_s - order_s);
  }
  const bool has_failed = !events.empty();
  time_.seconds = has_failed ? failure_s_ : last_s + nodes_ * machines_.report_s;
  if (has_failed) {
    time_.lost_s[size_t(Loss::failures)] += time_.seconds - begin_s;
    return 0;
  }
  pace_.round_done(time_.seconds - begin_s);
  time_.lost_s[size_t(loss)] +=
      time_.seconds - begin_s - double(passes) * machines_.pass_s / nodes_;
  left_ -= passes;
  return passes;
}

bool TeamRun::add_up() {
  // Along a chain, once over each cable; the first piece passes all nodes.
  const double piece_s = piece_gb / machines_.link_gb_s + machines_.message_s;
  const double seconds =
      nodes_ == 1
          ? 0
          : machines_.reduction * machines_.film_gb / machines_.link_gb_s + nodes_ * piece_s;
  if (!spend(seconds + machines_.file_gb / machines_.server_gb_s, Loss::adding)) return false;
  safe_left_ = left_;
  added_up_s_ = time_.seconds;
  return true;
}

}  // namespace kaustik::bench
