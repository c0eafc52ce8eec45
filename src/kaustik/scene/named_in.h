#pragma once
#include "kaustik/base/error.h"

namespace kaustik {

/// A problem of something that `place` names: in a file of its own it keeps its place and tells who
/// names it; without a place it gets this one. A part of an object of a program ("floor.bsdf" of
/// "floor") is no file of its own.
Problem named_in(Problem problem, const Place& place);

}  // namespace kaustik
