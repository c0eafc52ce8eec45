#pragma once
#include <memory>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// Spectra that stand as objects where a colour may, as in Mitsuba. They are values: what holds one
/// is made as if it had been given the number, the colour or the curve.
struct SpectrumType {
  const TypeInfo& info;
  /// The value for a `color` argument. Throws Error(input).
  Value (*value)(const Arguments&);
};
/// "blackbody", "d65", "irregular", "rawconstant", "regular", "srgb", "uniform".
const std::vector<SpectrumType>& spectrum_types();

/// The row of a spectrum; null for other objects, and for a `d65` that stands for the texture in
/// it.
const SpectrumType* spectrum_type_of(const Object& object);

/// The texture in a `d65`, or the object itself: light of the colours of a texture is what a
/// texture means on a lamp anyway.
const std::shared_ptr<Object>& texture_within(const std::shared_ptr<Object>& object);

/// The properties as the table of a spectrum takes them: a vector may stand for a colour.
std::vector<Property> spectrum_properties(const TypeInfo& info, const Object& spectrum);

}  // namespace kaustik
