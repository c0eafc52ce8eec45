#include "kaustik/loader/gltf/gltf_options.h"

#include "kaustik/base/photometric_units.h"
#include "kaustik/loader/reader_definitions.h"

namespace kaustik::gltf {

Options options_of(const LoadOptions& options) {
  const ReaderDefinitions definitions(options, {{"gltf.glass", {"auto", "solid", "thin"}},
                                                {"gltf.lamp_efficacy", {}},
                                                {"gltf.variant", {}},
                                                {"gltf.time", {}},
                                                {"gltf.animation", {}}});
  Options result{.lamp_efficacy =
                     definitions.number("gltf.lamp_efficacy", lumens_per_watt_white, 1e-3)};
  if (const std::string* glass = definitions.find("gltf.glass"))
    result.glass = *glass == "solid"  ? Glass::solid
                   : *glass == "thin" ? Glass::thin
                                      : Glass::automatic;
  if (const std::string* variant = definitions.find("gltf.variant")) result.variant = *variant;
  if (definitions.find("gltf.time")) result.time = definitions.number("gltf.time", 0, 0);
  if (const std::string* name = definitions.find("gltf.animation")) result.animation = *name;
  return result;
}

}  // namespace kaustik::gltf
