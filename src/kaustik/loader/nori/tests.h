#pragma once
#include <vector>

#include "kaustik/loader/nori/reading.h"
#include "kaustik/loader/nori_scene.h"

namespace kaustik::nori {

/// The claims of a <test>. Descriptions have no deviations yet: these are in `reading`, one list
/// for all.
std::vector<NoriTest> tests_of(const Object& element, Reading& reading);

}  // namespace kaustik::nori
