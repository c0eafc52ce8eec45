#include "kaustik/loader/pbrt/spectra.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/color.h"
#include "kaustik/loader/lower_case.h"
#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/spectrum_file.h"

namespace kaustik::pbrt {
namespace {

/// Chromaticities of the illuminants that pbrt knows by name (CIE 15, Colorimetry; ACES white).
struct Illuminant {
  std::string_view name;
  double x, y;
};
constexpr Illuminant illuminants[] = {
    {"stdillum-A", .44757, .40745},   {"stdillum-D50", .34567, .35850},
    {"stdillum-D65", .31271, .32902}, {"illum-acesD60", .32168, .33767},
    {"stdillum-F1", .31310, .33727},  {"stdillum-F2", .37208, .37529},
    {"stdillum-F3", .40910, .39430},  {"stdillum-F4", .44018, .40329},
    {"stdillum-F5", .31379, .34531},  {"stdillum-F6", .37790, .38835},
    {"stdillum-F7", .31292, .32933},  {"stdillum-F8", .34588, .35875},
    {"stdillum-F9", .37417, .37281},  {"stdillum-F10", .34609, .35986},
    {"stdillum-F11", .38052, .37713}, {"stdillum-F12", .43695, .40441}};

/// At the yellow helium line, from the makers' data sheets; pbrt's F names mean SF glasses.
struct Glass {
  std::string_view name;
  double index, abbe;
};
constexpr Glass glasses[] = {{"glass-BK7", 1.5168, 64.17},   {"glass-BAF10", 1.6700, 47.11},
                             {"glass-FK51A", 1.4866, 84.47}, {"glass-LASF9", 1.8503, 32.17},
                             {"glass-F5", 1.6727, 32.25},    {"glass-SF5", 1.6727, 32.25},
                             {"glass-F10", 1.7283, 28.41},   {"glass-SF10", 1.7283, 28.41},
                             {"glass-F11", 1.7847, 25.76},   {"glass-SF11", 1.7847, 25.76}};

const Glass* glass_of(const std::string& name) {
  const auto* found = std::ranges::find(glasses, name, &Glass::name);
  return found == std::end(glasses) ? nullptr : found;
}

constexpr std::string_view metals[] = {"ag", "al", "au", "cu", "cuzn", "mgo", "tio2"};

/// Near which an index of refraction counts where it is one number.
constexpr double yellow_nm = 587.6;

/// Of luminance 1 and such chromaticities, in Rec. 709.
Rgb colour_of_light(double x, double y) {
  const Rgb colour = rgb_from_xyz({x / y, 1, (1 - x - y) / y});
  return {std::max(0.0, colour.r), std::max(0.0, colour.g), std::max(0.0, colour.b)};
}

/// Linear between the samples, at least one; constant outside.
double at_wavelength(const SpectralCurve& curve, double nm) {
  const auto& samples = curve.samples;
  const auto next = std::ranges::find_if(samples, [nm](const auto& s) { return s.first > nm; });
  if (next == samples.begin()) return samples.front().second;
  if (next == samples.end()) return samples.back().second;
  const auto& [low_nm, low] = *(next - 1);
  return low + (next->second - low) * (nm - low_nm) / (next->first - low_nm);
}

/// Of Kaustik's; "": it is none.
std::string known_metal(const std::string& name) {
  const std::string metal = lower_case(name);
  return std::ranges::find(metals, metal) != std::end(metals) ? metal : std::string();
}

/// That whose index of refraction or extinction is in a file of such a name: "metals/Au.eta.spd".
std::string metal_of_file(const std::string& path) {
  const std::string file = path.substr(path.find_last_of("/\\") + 1);
  if (!file.ends_with(".eta.spd") && !file.ends_with(".k.spd")) return {};
  return known_metal(file.substr(0, file.find('.')));
}

}  // namespace

std::optional<double> index_of_glass(const std::string& name) {
  const Glass* glass = glass_of(name);
  return glass ? std::optional(glass->index) : std::nullopt;
}

std::optional<double> abbe_of_glass(const std::string& name) {
  const Glass* glass = glass_of(name);
  return glass ? std::optional(glass->abbe) : std::nullopt;
}

std::optional<double> abbe_of_index(const Value& value) {
  const auto* curve = std::get_if<SpectralCurve>(&value);
  if (!curve || curve->samples.empty()) return std::nullopt;
  // Hydrogen's F and C.
  const double spread = at_wavelength(*curve, 486.1) - at_wavelength(*curve, 656.3);
  if (!(spread > 0 && number_of_index(value) > 1)) return std::nullopt;
  return std::clamp((number_of_index(value) - 1) / spread, 1.0, 1000.0);
}

std::string metal_of(const std::string& name) {
  if (!name.starts_with("metal-")) return {};
  return known_metal(name.substr(6, name.rfind('-') - 6));
}

double number_of_index(const Value& value) {
  if (const auto number = as_number(value)) return *number;
  if (const auto* colour = std::get_if<Rgb>(&value)) return colour->g;
  const auto* curve = std::get_if<SpectralCurve>(&value);
  return curve && !curve->samples.empty() ? at_wavelength(*curve, yellow_nm) : 1.5;
}

std::string Spectra::name_of(const ParameterList& list, std::string_view name) {
  const Parameter* parameter = list.find(name, {"spectrum"});
  return parameter && !parameter->texts.empty() ? parameter->texts.front() : std::string();
}

std::string Spectra::metal_in(const ParameterList& list, std::string_view name,
                              const Owner& owner) {
  const std::string given = name_of(list, name);
  if (const std::string metal = metal_of(given); !metal.empty()) return metal;
  const std::string metal = metal_of_file(given);
  if (metal.empty() || files_.find(given, list.place_of(name))) return {};
  deviations_.missing(
      owner.object,
      fmt::format("there is no spectrum {}: the metal '{}' stands for it", shown(given), metal),
      list.place_of(name));
  return metal;
}

std::optional<Value> Spectra::read(const ParameterList& list, std::string_view name,
                                   SpectrumUse use, const Owner& owner) {
  const Parameter* parameter =
      list.find(name, {"rgb", "xyz", "blackbody", "spectrum", "float", "integer"});
  if (!parameter) return std::nullopt;
  return of_parameter(*parameter, use, owner);
}

Value Spectra::of_parameter(const Parameter& parameter, SpectrumUse use, const Owner& owner) {
  if (parameter.type == "rgb" || parameter.type == "xyz") return of_rgb(parameter, use, owner);
  if (parameter.type == "spectrum")
    return parameter.texts.empty() ? of_samples(parameter, use, owner)
                                   : of_name(parameter, use, owner);
  if (parameter.number_count() == 0)
    throw Error(ErrorKind::input, fmt::format("{} has no number", shown(parameter.name)),
                "give it one", parameter.place);
  const double number = parameter.number(0);
  if (parameter.type != "blackbody") {
    const double most = use == SpectrumUse::reflectance ? 1 : 1e30;
    return std::clamp(number, 0.0, most);
  }
  if (!(number >= 200 && number <= 1e6))
    throw Error(ErrorKind::input, fmt::format("{} K is no temperature of a light", number),
                "give one from 200 to 1000000", parameter.place);
  if (parameter.number_count() > 1)
    deviations_.ignored(owner.object,
                        fmt::format("of {} the temperature alone counts", shown(parameter.name)),
                        parameter.place);
  return of_curve(blackbody_curve(number), use, parameter, owner);
}

Value Spectra::of_rgb(const Parameter& parameter, SpectrumUse use, const Owner& owner) {
  if (parameter.numbers.size() < 3)
    throw Error(ErrorKind::input, fmt::format("{} is no colour", shown(parameter.name)),
                "give three numbers: red, green, blue", parameter.place);
  const Rgb given{parameter.numbers[0], parameter.numbers[1], parameter.numbers[2]};
  Rgb colour = given;
  if (parameter.type == "xyz") {
    colour = rgb_from_xyz({given.r, given.g, given.b});
  } else {
    colour = use == SpectrumUse::light ? light_from(owner.space, given)
                                       : reflectance_from(owner.space, given);
  }
  const double most = use == SpectrumUse::reflectance ? 1 : 1e30;
  const Rgb kept{std::clamp(colour.r, 0.0, most), std::clamp(colour.g, 0.0, most),
                 std::clamp(colour.b, 0.0, most)};
  const auto differs = [](double a, double b) { return std::fabs(a - b) > 1e-6; };
  if (differs(kept.r, colour.r) || differs(kept.g, colour.g) || differs(kept.b, colour.b))
    deviations_.approximated(
        owner.object,
        fmt::format("colour {} is taken into what Rec. 709 can show", shown(parameter.name)),
        parameter.place);
  return kept;
}

Value Spectra::of_samples(const Parameter& parameter, SpectrumUse use, const Owner& owner) {
  const std::vector<double>& numbers = parameter.numbers;
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorKind::input, message,
                "give wavelengths in nanometres, ascending, each with "
                "a value",
                parameter.place);
  };
  if (numbers.size() < 2 || numbers.size() % 2 != 0)
    refuse(fmt::format("spectrum {} has {} numbers", shown(parameter.name), numbers.size()));
  SpectralCurve curve;
  for (size_t i = 0; i < numbers.size(); i += 2) {
    if (!(numbers[i] > 0) || (i > 0 && !(numbers[i] > numbers[i - 2])))
      refuse(fmt::format("wavelengths of spectrum {} do not ascend", shown(parameter.name)));
    curve.samples.emplace_back(numbers[i], std::max(0.0, numbers[i + 1]));
  }
  return of_curve(std::move(curve), use, parameter, owner);
}

Value Spectra::of_name(const Parameter& parameter, SpectrumUse use, const Owner& owner) {
  const std::string& name = parameter.texts.front();
  for (const Illuminant& known : illuminants)
    if (known.name == name) {
      Value value = colour_of_light(known.x, known.y);
      if (use == SpectrumUse::reflectance) multiply_value(value, 0.5);
      return value;
    }
  if (const auto index = index_of_glass(name)) return *index;
  if (const auto path = files_.find(name, parameter.place)) {
    const FileCurve& file = curve_in(path->string());
    if (file.fault.empty()) {
      files_.spend(file.curve.samples.size() * sizeof(file.curve.samples[0]), parameter.place);
      return of_curve(file.curve, use, parameter, owner);
    }
    deviations_.missing(owner.object,
                        fmt::format("spectrum {} can't be read: {}", shown(name), file.fault),
                        parameter.place);
    return use == SpectrumUse::reflectance ? 0.5 : 1.0;
  }
  deviations_.missing(owner.object, fmt::format("there is no spectrum {}", shown(name)),
                      parameter.place);
  return use == SpectrumUse::reflectance ? 0.5 : 1.0;
}

const Spectra::FileCurve& Spectra::curve_in(const std::string& path) {
  const auto [entry, is_new] = file_curves_.try_emplace(path);
  FileCurve& file = entry->second;
  if (!is_new) return file;
  try {
    file.curve = read_spectrum_file(path);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    file.fault = error.problems().front().message;
  }
  return file;
}

Value Spectra::of_curve(SpectralCurve curve, SpectrumUse use, const Parameter& parameter,
                        const Owner& owner) {
  if (use == SpectrumUse::light) {
    if (keeps_brightness_ && parameter.type == "spectrum") return curve;
    const double brightness = luminance(curve);
    Value value = std::move(curve);
    multiply_value(value, brightness > 0 ? 1 / brightness : 0);
    return value;
  }
  bool is_cut = false;
  if (use == SpectrumUse::reflectance)
    for (auto& sample : curve.samples) {
      is_cut |= sample.second > 1 + 1e-6;
      sample.second = std::min(sample.second, 1.0);
    }
  if (is_cut)
    deviations_.approximated(
        owner.object,
        fmt::format("{} reflects more than all: it is cut to 1", shown(parameter.name)),
        parameter.place);
  return curve;
}

}  // namespace kaustik::pbrt
