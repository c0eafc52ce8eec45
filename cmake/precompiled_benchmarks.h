// What most benchmarks include, for the check that they compile: see benchmarks/CMakeLists.txt.
#include "kaustik/image/image_io.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/job.h"
#include "kaustik/scene/overrides.h"
#include "precompiled_library.h"
