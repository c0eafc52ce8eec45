#include "kaustik/volume/volume_kinds.h"

namespace kaustik {
namespace {

const TypeInfo& constvolume_info() {
  static const TypeInfo info{
      "volume",
      "constvolume",
      "One value everywhere.",
      {color_parameter("value", 1, "The value: a number, a colour or a spectrum."),
       ignored_parameter("to_world", ParameterKind::transform)}};
  return info;
}

std::shared_ptr<const Volume> create_constvolume(const Arguments& arguments) {
  return std::make_shared<Volume>(arguments.color("value"));
}

}  // namespace

VolumeType constvolume_type() { return {constvolume_info(), create_constvolume}; }

}  // namespace kaustik
