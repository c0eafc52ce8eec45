#pragma once
#include <memory>

#include "kaustik/render/team.h"

namespace kaustik::app {

/// The processes that share the passes of `kaustik render`; null: this one is alone.
const std::shared_ptr<Team>& render_team();
/// Before the command begins. From then on followers say nothing but what goes wrong.
void join_team(std::shared_ptr<Team> team);
/// One of several, and not the one that writes what there is to be written.
bool is_follower();

}  // namespace kaustik::app
