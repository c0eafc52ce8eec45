#pragma once
// Spectra as pbrt writes them: rgb, blackbody, samples, names, files.

#include <map>
#include <optional>
#include <string>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/pbrt/colour_space.h"
#include "kaustik/loader/pbrt/parameters.h"
#include "kaustik/loader/pbrt/scene_files.h"

namespace kaustik::pbrt {

/// What a spectrum is for decides what its numbers mean.
enum class SpectrumUse {
  reflectance,  ///< within 0 and 1
  coefficient,  ///< any number from 0: indices of refraction, absorption
  light         ///< rgb counts as it is, all else is brought to the luminance 1 (not in pbrt-v3)
};

/// Whose parameter is read: for what is told, and the colours that it is written in.
struct Owner {
  std::string object;  ///< "material 'glass'"
  ColourSpace space = ColourSpace::srgb;
  size_t sequence = 0;  ///< how many things were defined before it
};

class Spectra {
 public:
  Spectra(SceneFiles& files, Deviations& deviations) : files_(files), deviations_(deviations) {}

  /// The value of a parameter of type rgb, blackbody, spectrum, or float; nothing if there is none.
  /// Throws Error(input) for values that are none.
  std::optional<Value> read(const ParameterList& list, std::string_view name, SpectrumUse use,
                            const Owner& owner);
  /// As pbrt-v3: samples of light count as they are.
  void keep_brightness_of_light() { keeps_brightness_ = true; }
  /// The name that a spectrum has instead of values, such as "metal-Cu-eta"; "" if it has none.
  static std::string name_of(const ParameterList& list, std::string_view name);
  /// metal_of() that name; also of a file that is not there ("metals/Au.eta.spd"), which is told.
  std::string metal_in(const ParameterList& list, std::string_view name, const Owner& owner);

 private:
  Value of_parameter(const Parameter& parameter, SpectrumUse use, const Owner& owner);
  Value of_rgb(const Parameter& parameter, SpectrumUse use, const Owner& owner);
  Value of_samples(const Parameter& parameter, SpectrumUse use, const Owner& owner);
  Value of_name(const Parameter& parameter, SpectrumUse use, const Owner& owner);
  Value of_curve(SpectralCurve curve, SpectrumUse use, const Parameter& parameter,
                 const Owner& owner);

  /// What a file holds, which is read once.
  struct FileCurve {
    SpectralCurve curve;
    std::string fault;  ///< why it is none; "": it is one
  };
  const FileCurve& curve_in(const std::string& path);

  SceneFiles& files_;
  Deviations& deviations_;
  std::map<std::string, FileCurve> file_curves_;
  bool keeps_brightness_ = false;
};

/// Index of refraction of a named glass at 587.6 nm, such as "glass-BK7"; nothing: there is none.
std::optional<double> index_of_glass(const std::string& name);
/// The Abbe number of such a glass.
std::optional<double> abbe_of_glass(const std::string& name);
/// The same of an index that is given as a curve; nothing: it is none, or does not fall with the
/// wavelength.
std::optional<double> abbe_of_index(const Value& value);
/// Kaustik's name of a metal whose eta or k is named, such as "cu" of "metal-Cu-k"; "": none.
std::string metal_of(const std::string& name);
/// One number of what may be a curve, which counts near 588 nm; of a colour its green.
double number_of_index(const Value& value);

}  // namespace kaustik::pbrt
