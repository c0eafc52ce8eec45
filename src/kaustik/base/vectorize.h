#pragma once

/// Before a loop whose turns do not depend on one another, where pointers do not tell the compiler.
#if defined(__GNUC__) && !defined(__clang__)
#define KAUSTIK_INDEPENDENT_TURNS _Pragma("GCC ivdep")
#else
#define KAUSTIK_INDEPENDENT_TURNS
#endif
