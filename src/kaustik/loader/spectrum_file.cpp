#include "kaustik/loader/spectrum_file.h"

#include "kaustik/base/file.h"
#include "kaustik/loader/mitsuba_values.h"

namespace kaustik {
namespace {

constexpr size_t maximum_bytes = size_t{64} << 20;

[[noreturn]] void fail(const std::string& message, const std::string& remedy, const Place& place) {
  throw Error(ErrorKind::input, message, remedy, place);
}

/// What stands on a line; comments and blanks apart.
void read_line(std::string_view line, const Place& place, SpectralCurve& curve) {
  const auto words = mitsuba::split_list(line.substr(0, line.find('#')));
  if (words.empty()) return;
  double numbers[2] = {0, 0};
  try {
    if (words.size() != 2) throw mitsuba::BadValue("not two words");
    for (const size_t i : {0, 1}) numbers[i] = mitsuba::parse_float(words[i]);
  } catch (const mitsuba::BadValue&) {
    fail("this line of the spectrum is not two numbers",
         "write a wavelength in nanometres and a value on each line", place);
  }
  try {
    mitsuba::append_sample(curve, numbers[0], numbers[1]);
  } catch (const mitsuba::BadValue& bad) {
    fail(bad.what(), bad.remedy, place);
  }
}

}  // namespace

SpectralCurve read_spectrum_file(const std::string& path) {
  const auto name = std::make_shared<const std::string>(path);
  const std::vector<uint8_t> bytes = read_file_start(path, maximum_bytes + 1);
  if (bytes.size() > maximum_bytes)
    fail("the spectrum has more than 64 MiB", "name a file of wavelengths and values",
         Place{name, 0, 0});
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  SpectralCurve curve;
  for (int line = 1; !rest.empty(); ++line) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    read_line(rest.substr(0, end), Place{name, line, 0}, curve);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (curve.samples.size() < 2)
    fail(curve.samples.empty() ? "the spectrum is empty"
                               : "the spectrum has one wavelength: it is zero everywhere else",
         "write a wavelength in nanometres and a value on each line, at least two",
         Place{name, 0, 0});
  try {
    mitsuba::expect_nanometres(curve);
  } catch (const mitsuba::BadValue& bad) {
    fail(bad.what(), bad.remedy, Place{name, 0, 0});
  }
  return curve;
}

}  // namespace kaustik
