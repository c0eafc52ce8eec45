#pragma once
// The values of attributes: from text to numbers, lists, colours, as Mitsuba 3 writes them.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/parameters.h"

namespace kaustik::mitsuba {

/// A value that cannot be understood. Whoever knows where it stands adds the place.
class BadValue : public std::runtime_error {
 public:
  explicit BadValue(const std::string& message, std::string remedy_text = {}, Place where = {})
      : std::runtime_error(message), remedy(std::move(remedy_text)), place(std::move(where)) {}
  std::string remedy;
  Place place;
};

/// Text for a message: in quotes, cut where it is too long to help.
std::string in_quotes(std::string_view text);
/// "did you mean …? Valid: …", with short lists and without names that are too long to compare.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

/// Parts of a list: separated by commas and white space, none empty.
std::vector<std::string_view> split_list(std::string_view text);

// Each throws BadValue. White space around a value does not count.
double parse_float(std::string_view text);  ///< always finite
int64_t parse_integer(std::string_view text);
bool parse_boolean(std::string_view text);
/// Three numbers.
Vec3d parse_vector(std::string_view text);
/// One number for all channels or three, linear; or "#rrggbb" in sRGB, which is decoded.
Rgb parse_rgb(std::string_view text);
/// As parse_rgb(), but "#rrggbb" is linear, too (Mitsuba 0.6).
Rgb parse_rgb_of_old_scenes(std::string_view text);
/// As parse_rgb(), but the numbers are sRGB too (Mitsuba 0.6).
Rgb parse_srgb(std::string_view text);
/// One number (a double: the same in every lane) or at least two "wavelength:value" pairs (a
/// SpectralCurve).
Value parse_spectrum(std::string_view text);
/// The same of Mitsuba 0.6, where three numbers are red, green and blue.
Value parse_old_spectrum(std::string_view text);
/// A temperature, which may end in K.
double parse_kelvin(std::string_view text);

/// Appends a sample to a curve; throws BadValue unless the wavelength is positive and ascends.
void append_sample(SpectralCurve& curve, double wavelength_nm, double value);
/// Throws BadValue where a whole curve, of one sample at least, must be meant in micrometres.
void expect_nanometres(const SpectralCurve& curve);

}  // namespace kaustik::mitsuba
