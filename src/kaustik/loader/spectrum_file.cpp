#include "kaustik/loader/spectrum_file.h"

#include <fmt/format.h>

#include "kaustik/base/file.h"
#include "kaustik/loader/mitsuba_values.h"

namespace kaustik {

SpectralCurve read_spectrum_file(const std::string& path) {
  const std::vector<uint8_t> bytes = read_file(path);
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto name = std::make_shared<const std::string>(path);
  SpectralCurve curve;
  for (int line = 1; !rest.empty(); ++line) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    const auto numbers = mitsuba::split_list(rest.substr(0, std::min(end, rest.find('#'))));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (numbers.empty()) continue;
    try {
      if (numbers.size() != 2)
        throw mitsuba::BadValue(fmt::format("{} values instead of 2", numbers.size()),
                                "write a wavelength in nanometres and a value on each line");
      mitsuba::append_sample(curve, mitsuba::parse_float(numbers[0]),
                             mitsuba::parse_float(numbers[1]));
    } catch (const mitsuba::BadValue& bad) {
      throw Error(ErrorKind::input, bad.what(), bad.remedy, Place{name, line, 0});
    }
  }
  if (curve.samples.empty())
    throw Error(ErrorKind::input, "the spectrum is empty",
                "write a wavelength in nanometres and a value on each line", Place{name, 0, 0});
  return curve;
}

}  // namespace kaustik
