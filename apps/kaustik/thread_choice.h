#pragma once
#include <string>

#include "kaustik/base/processors.h"

namespace kaustik::app {

/// Threads to use where `asked` are asked for (0: all): no more than the process may keep busy.
/// Warns if fewer are used than were asked for, and if a launcher has bound the process to one
/// processor of many; unless `is_quiet` tells how many of how many are used where these differ.
int usable_threads(int asked, bool is_quiet);

/// "4 of 16 cores: the process is bound to 4"; "" if all may be used.
std::string text_of(const Processors& processors);

}  // namespace kaustik::app
