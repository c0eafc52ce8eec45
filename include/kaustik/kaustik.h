#pragma once
// Kaustik in other programs: docs/guides/cpp.md. These headers include the standard library only.

#include "kaustik/error.h"
#include "kaustik/estimate.h"
#include "kaustik/mesh.h"
#include "kaustik/picture.h"
#include "kaustik/points.h"
#include "kaustik/scene.h"
#include "kaustik/session.h"
#include "kaustik/value.h"
#include "kaustik/version.h"

namespace kaustik {
/// The interface of version 0; programs write kaustik::Scene.
using namespace v0;
}  // namespace kaustik
