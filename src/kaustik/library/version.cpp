#include "kaustik/version.h"

#include "kaustik/base/version.h"

namespace kaustik::v0 {

const char* version() noexcept { return KAUSTIK_VERSION; }

}  // namespace kaustik::v0
