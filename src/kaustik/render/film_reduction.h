#pragma once
#include "kaustik/render/film.h"
#include "kaustik/render/team.h"

namespace kaustik {

/// Adds the passes of all members' films, none of them in two, to the leader's. The others' are
/// empty then. Holds some 64 MB of unpacked sums at a time.
void add_films(Team& team, Film& film);

}  // namespace kaustik
