#pragma once
#include "kaustik/base/parameters.h"

namespace kaustik {

// Integrators of Mitsuba that go by another name here, with Mitsuba's parameters.

const TypeInfo& volpath_info();         ///< path
const TypeInfo& volpathmis_info();      ///< path
const TypeInfo& volpath_simple_info();  ///< path; of Mitsuba 0.6
const TypeInfo& direct_info();          ///< path of two segments
const TypeInfo& ptracer_info();         ///< lighttracer

}  // namespace kaustik
