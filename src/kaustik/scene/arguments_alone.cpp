#include "kaustik/scene/arguments_alone.h"

#include "kaustik/scene/type_tables.h"

namespace kaustik {

Arguments arguments_alone(const Object& object) {
  const TypeInfo& info = *scene_types().find(object.family, object.type);
  Problems problems;
  UnknownParameters unknown;
  Arguments arguments(info, unknown.without_unknown(info, object.properties), object.place,
                      problems);
  problems.throw_if_any();
  return arguments;
}

}  // namespace kaustik
