#include "kaustik/loader/mitsuba_values.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>

#include "kaustik/base/text_lines.h"
#include "kaustik/loader/near_names.h"

namespace kaustik::mitsuba {
namespace {

constexpr std::string_view list_separators = ", \t\r\n";
constexpr size_t longest_quote = 60;
constexpr size_t longest_list = 40;

/// from_chars knows no plus sign, scene files do.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

/// The electro-optical transfer function of IEC 61966-2-1.
double linear_from_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

Rgb linear_from_srgb(const Rgb& c) {
  return {linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)};
}

Rgb parse_hexadecimal(std::string_view text) {
  uint32_t code = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), code, 16);
  if (text.size() != 7 || error != std::errc{} || end != text.data() + text.size())
    throw BadValue(fmt::format("{} is not a colour", in_quotes(text)),
                   "write six hexadecimal digits after the '#', as in #ff8000");
  return {double(code >> 16) / 255, double((code >> 8) & 255) / 255, double(code & 255) / 255};
}

Rgb parse_three_or_one(std::string_view text) {
  const auto parts = split_list(text);
  if (parts.size() != 1 && parts.size() != 3)
    throw BadValue(
        fmt::format("{} has {} values, a colour has 3 or 1", in_quotes(text), parts.size()),
        "write red, green and blue, as in \"0.8, 0.5, 0.2\"");
  const double first = parse_float(parts[0]);
  if (parts.size() == 1) return {first, first, first};
  return {first, parse_float(parts[1]), parse_float(parts[2])};
}

}  // namespace

std::string in_quotes(std::string_view text) {
  if (text.size() <= longest_quote) return fmt::format("'{}'", text);
  size_t end = longest_quote;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return fmt::format("'{}…'", text.substr(0, end));
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  std::vector<std::string> comparable;
  for (const std::string& candidate : candidates)
    if (candidate.size() <= longest_quote) comparable.push_back(candidate);
  if (name.size() <= longest_quote && comparable.size() <= longest_list)
    return suggest(name, comparable);
  return name.size() <= longest_quote ? did_you_mean(name, comparable) : std::string();
}

std::vector<std::string_view> split_list(std::string_view text) {
  std::vector<std::string_view> parts;
  size_t begin = text.find_first_not_of(list_separators);
  while (begin != std::string_view::npos) {
    const size_t end = std::min(text.find_first_of(list_separators, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(list_separators, end);
  }
  return parts;
}

double parse_float(std::string_view text) {
  std::string_view digits = without_plus(trimmed(text));
  // As programs write floats.
  if (digits.size() > 1 && digits.ends_with('f') &&
      (std::isdigit(static_cast<unsigned char>(digits[digits.size() - 2])) != 0 ||
       digits[digits.size() - 2] == '.'))
    digits.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range)
    throw BadValue(fmt::format("{} is out of the range of numbers", in_quotes(text)),
                   "write a number between 1e-300 and 1e300");
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size())
    throw BadValue(fmt::format("{} is not a number", in_quotes(text)),
                   "write a number such as 2, 0.5 or 1e-3");
  if (!std::isfinite(value))
    throw BadValue(fmt::format("{} is not a finite number", in_quotes(text)),
                   "write a finite number");
  return value;
}

int64_t parse_integer(std::string_view text) {
  const std::string_view digits = without_plus(trimmed(text));
  int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range)
    throw BadValue(fmt::format("{} is out of the range of integers", in_quotes(text)),
                   "integers have 64 bits");
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size())
    throw BadValue(fmt::format("{} is not an integer", in_quotes(text)),
                   "write digits only, as in 64, or use <float>");
  return value;
}

bool parse_boolean(std::string_view text) {
  std::string word(trimmed(text));
  for (char& c : word) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (word == "true") return true;
  if (word == "false") return false;
  throw BadValue(fmt::format("{} is not a boolean", in_quotes(text)), "write true or false");
}

Vec3d parse_vector(std::string_view text) {
  const auto parts = split_list(text);
  if (parts.size() != 3)
    throw BadValue(fmt::format("{} has {} values instead of 3", in_quotes(text), parts.size()),
                   "write x, y and z, as in \"0, 1, 0\"");
  return {parse_float(parts[0]), parse_float(parts[1]), parse_float(parts[2])};
}

Rgb parse_rgb(std::string_view text) {
  const std::string_view word = trimmed(text);
  return word.starts_with('#') ? linear_from_srgb(parse_hexadecimal(word))
                               : parse_three_or_one(word);
}

Rgb parse_rgb_of_old_scenes(std::string_view text) {
  const std::string_view word = trimmed(text);
  return word.starts_with('#') ? parse_hexadecimal(word) : parse_three_or_one(word);
}

Rgb parse_srgb(std::string_view text) {
  const std::string_view word = trimmed(text);
  return linear_from_srgb(word.starts_with('#') ? parse_hexadecimal(word)
                                                : parse_three_or_one(word));
}

Value parse_spectrum(std::string_view text) {
  const auto parts = split_list(text);
  const std::string_view remedy =
      "write one number, or pairs such as \"400:0.1, 500:0.2\", or use <rgb>";
  if (parts.empty()) throw BadValue("the spectrum is empty", std::string(remedy));
  if (parts[0].starts_with('#'))
    throw BadValue(fmt::format("{} is a colour, not a spectrum", in_quotes(parts[0])),
                   "write <rgb> instead of <spectrum>");
  if (parts.size() == 1 && parts[0].find(':') == std::string_view::npos)
    return parse_float(parts[0]);
  if (parts.size() == 3 && parts[0].find(':') == std::string_view::npos)
    throw BadValue(fmt::format("{} are three numbers, not a spectrum", in_quotes(trimmed(text))),
                   "write <rgb> instead of <spectrum> for red, green and blue");
  SpectralCurve curve;
  for (const std::string_view part : parts) {
    const size_t colon = part.find(':');
    if (colon == std::string_view::npos)
      throw BadValue(fmt::format("{} is not a pair of wavelength and value", in_quotes(part)),
                     std::string(remedy));
    append_sample(curve, parse_float(part.substr(0, colon)), parse_float(part.substr(colon + 1)));
  }
  if (curve.samples.size() < 2)
    throw BadValue("a curve of one wavelength is zero everywhere else",
                   "give the ends of a range, such as \"360:0.5, 830:0.5\"");
  expect_nanometres(curve);
  return curve;
}

Value parse_old_spectrum(std::string_view text) {
  const bool is_rgb = split_list(text).size() == 3 && text.find(':') == std::string_view::npos;
  return is_rgb ? Value(parse_three_or_one(text)) : parse_spectrum(text);
}

double parse_kelvin(std::string_view text) {
  std::string_view number = trimmed(text);
  if (!number.empty() && (number.back() == 'K' || number.back() == 'k')) number.remove_suffix(1);
  return parse_float(number);
}

void expect_nanometres(const SpectralCurve& curve) {
  constexpr double least_nm = 10;
  if (const double last = curve.samples.back().first; last < least_nm)
    throw BadValue(fmt::format("its wavelengths end at {} nm, where nothing is seen", last),
                   "give nanometres: a micrometre has 1000");
}

void append_sample(SpectralCurve& curve, double wavelength_nm, double value) {
  if (!(wavelength_nm > 0))
    throw BadValue(fmt::format("wavelength {} is not positive", wavelength_nm),
                   "wavelengths are in nanometres");
  if (!curve.samples.empty() && wavelength_nm <= curve.samples.back().first)
    throw BadValue(
        fmt::format("wavelength {} follows {}", wavelength_nm, curve.samples.back().first),
        "list each wavelength once, in increasing order");
  curve.samples.emplace_back(wavelength_nm, value);
}

}  // namespace kaustik::mitsuba
