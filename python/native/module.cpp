#include "bind.h"
#include "kaustik/base/version.h"
#include "kaustik/base/wavelengths.h"

PYBIND11_MODULE(_native, module) {
  using namespace kaustik::python;
  module.doc() = "The compiled part of kaustik. Use the package, not this.";
  module.attr("version") = KAUSTIK_VERSION;
  module.attr("first_nm") = double(kaustik::Wavelengths::first_nm);
  module.attr("last_nm") = double(kaustik::Wavelengths::last_nm);
  bind_errors(module);
  bind_arrays(module);
  bind_transforms(module);
  bind_types(module);
  bind_scenes(module);
  bind_images(module);
  bind_films(module);
  bind_jobs(module);
  bind_photons(module);
  bind_views(module);
}
