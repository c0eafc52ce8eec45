#include "render_team.h"

#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "screen.h"

namespace kaustik::app {
namespace {

std::shared_ptr<Team>& joined_team() {
  static std::shared_ptr<Team> team;
  return team;
}

/// Most mistakes are those of all processes: the leader tells them, and ends the others.
constexpr std::chrono::seconds time_for_leader(5);

void tell_errors_only(Level level, const std::string& text) {
  if (level != Level::error) return;
  std::this_thread::sleep_for(time_for_leader);
  std::fputs(fmt::format("process {}: error: {}\n", joined_team()->rank(), text).c_str(), stderr);
}

}  // namespace

const std::shared_ptr<Team>& render_team() { return joined_team(); }

void join_team(std::shared_ptr<Team> team) {
  joined_team() = std::move(team);
  if (is_follower()) screen().hand_messages_to(tell_errors_only);
}

bool is_follower() { return joined_team() && !joined_team()->is_led_here(); }

}  // namespace kaustik::app
