#pragma once

/// What the shared library shows of itself.
#define KAUSTIK_EXPORT __attribute__((visibility("default")))
