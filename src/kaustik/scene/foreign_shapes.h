#pragma once
#include <string>

namespace kaustik {

/// What to do about a shape that other renderers have and this one has not; "" for types that
/// nobody has.
std::string remedy_for_foreign_shape(const std::string& type);

}  // namespace kaustik
