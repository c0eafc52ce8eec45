#pragma once
// Short ways to describe objects.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/loader/object_maker.h"

namespace kaustik::radiance {

using ObjectPointer = std::shared_ptr<Object>;

inline void nest(Object& object, ObjectPointer child, std::string name = {}) {
  put(object, std::move(name), std::move(child));
}

}  // namespace kaustik::radiance
