#pragma once
// The parameter tables: each type of object (integrator, light, shape, bsdf, film, …) declares its
// parameters once; checks, error messages, `kaustik help` and the manual come from that one table.

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kaustik/base/array.h"
#include "kaustik/base/error.h"
#include "kaustik/base/transform.h"

namespace kaustik {

/// Linear Rec. 709.
struct Rgb {
  double r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};
/// Values over wavelength in nm, ascending, at least one; linear between. Beyond its ends light and
/// reflectances are zero, and indices of refraction and extinctions stay as they are there.
struct SpectralCurve {
  std::vector<std::pair<double, double>> samples;
  friend bool operator==(const SpectralCurve&, const SpectralCurve&) = default;
};
/// Text from the command line whose type only the table knows.
struct Untyped {
  std::string text;
  friend bool operator==(const Untyped&, const Untyped&) = default;
};

/// An array is never null. No text format has arrays: programs put them into descriptions.
using Value = std::variant<bool, int64_t, double, std::string, Vec3d, Rgb, SpectralCurve, Transform,
                           Untyped, std::shared_ptr<const Array>>;

/// A named value and where it was given.
struct Property {
  std::string name;
  Value value;
  Place place;
  std::string written = {};  ///< what its file calls it; "": the same

  const std::string& spelling() const { return written.empty() ? name : written; }
};

enum class ParameterKind {
  boolean,
  integer,
  number,
  text,
  choice,          ///< text out of a list, compared without case
  number_or_name,  ///< a number, or text out of a list that stands for one
  point,           ///< also serves vectors
  color,           ///< rgb, a spectrum, or one number for all lanes
  transform,
  file,  ///< a path, relative to the file that names it; given as text
  array  ///< a buffer, from programs only
};

/// What becomes of a value when its object is moved in the world.
enum class WhenMoved : uint8_t {
  stays,     ///< it lies in the object's own space, or is no place at all
  composed,  ///< the transform from the object's space to the world: the movement comes after it
  origin,    ///< a point that stands for the translation there instead of that transform
  turned     ///< a direction in the world
};

/// One row of a table.
struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::number;
  std::variant<std::monostate, Value>
      default_value;  ///< monostate: required or absent, see `required`
  bool required = false;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  std::string unit;      ///< "" for none
  std::string sentence;  ///< one sentence of help
  std::vector<std::string> choices;
  /// What a file gives beyond the range is taken to its nearer end, with a warning: Mitsuba has no
  /// such bound, or draws it in silence.
  bool is_clamped = false;
  bool no_effect = false;        ///< accepted because Mitsuba has it; reported once
  bool accepts_texture = false;  ///< a nested texture object may stand instead of the value
  bool accepts_volume = false;   ///< a nested volume may
  /// The parameter that this one stands instead of: not both can be given, and where that one is
  /// required this one will do. "" for none.
  std::string stands_for;
  WhenMoved when_moved = WhenMoved::stays;
  int least_dimensions = 3;     ///< of transforms, see Transform::dimensions()
  std::vector<size_t> extents;  ///< of arrays, 0 for any number; none: any shape
  bool of_integers = false;     ///< of arrays: no floats

  Parameter& range(double low, double high) { return minimum = low, maximum = high, *this; }
  Parameter& clamped() { return is_clamped = true, *this; }
  Parameter& in(std::string unit_name) { return unit = std::move(unit_name), *this; }
  Parameter& textured() { return accepts_texture = true, *this; }
  Parameter& or_volume() { return accepts_volume = true, *this; }
  Parameter& instead_of(std::string other) { return stands_for = std::move(other), *this; }
  Parameter& moved(WhenMoved how) { return when_moved = how, *this; }
  /// A transform need not leave all dimensions of space.
  Parameter& leaving(int dimensions) { return least_dimensions = dimensions, *this; }
  Parameter& integers() { return of_integers = true, *this; }
};

Parameter boolean_parameter(std::string name, bool default_value, std::string sentence);
Parameter integer_parameter(std::string name, int64_t default_value, std::string sentence);
Parameter number_parameter(std::string name, double default_value, std::string sentence);
Parameter text_parameter(std::string name, std::string default_value, std::string sentence);
Parameter choice_parameter(std::string name, std::string default_value,
                           std::vector<std::string> choices, std::string sentence);
/// `default_value` may be a number or one of the names.
Parameter number_or_name_parameter(std::string name, Value default_value,
                                   std::vector<std::string> names, std::string sentence);
Parameter point_parameter(std::string name, Vec3d default_value, std::string sentence);
Parameter color_parameter(std::string name, double default_value, std::string sentence);
Parameter transform_parameter(std::string name, std::string sentence);
/// `to_world`, which places an object in the world.
Parameter to_world_parameter(std::string sentence);
/// Required.
Parameter file_parameter(std::string name, std::string sentence);
/// Optional; `extents` as of the row.
Parameter array_parameter(std::string name, std::vector<size_t> extents, std::string sentence);
/// A parameter of Mitsuba's that means nothing here.
Parameter ignored_parameter(std::string name, ParameterKind kind);
/// The same row without a default: it may be absent (ask Arguments::has) …
Parameter optional(Parameter parameter);
/// … or must be given.
Parameter required(Parameter parameter);

/// The table of one type.
struct TypeInfo {
  std::string family;  ///< "bsdf", "shape", …
  std::string name;    ///< "diffuse", …
  std::string sentence;
  std::vector<Parameter> parameters;

  const Parameter* find(std::string_view parameter_name) const;
  std::vector<std::string> parameter_names() const;
};

/// What files give and no table knows: foreign programs write parameters and types of their own.
/// They are left out, and told once for each kind, with how many there were.
class UnknownParameters {
 public:
  /// The properties that the table knows (toWorld as to_world), and those that no file gave: who
  /// types a name or writes a program is told of a mistake as of an error.
  std::vector<Property> without_unknown(const TypeInfo& info,
                                        const std::vector<Property>& properties);
  /// Counts what is left out elsewhere; `text` says what it is and what follows, `nearest` ("":
  /// none) what it may be meant for.
  void add(const std::string& text, const Place& place, const std::string& nearest = {});
  /// A sentence for each.
  std::vector<std::string> warnings() const;

 private:
  struct Found {
    Place first;
    std::string nearest;
    int count = 0;
  };
  std::map<std::string, Found> found_;
};

/// Given properties checked against a table. Everything wrong (unknown name with the nearest valid
/// one, wrong type, out of range, missing, given twice) goes to `problems`; such a parameter then
/// reads as its default, so that building can go on and collect more problems.
class Arguments {
 public:
  /// `info` must outlive this.
  Arguments(const TypeInfo& info, const std::vector<Property>& given, const Place& place,
            Problems& problems);

  const TypeInfo& info() const { return *info_; }
  const Place& place() const { return place_; }
  /// Given by the user, or has a default.
  bool has(std::string_view name) const;
  /// Given by the user.
  bool given(std::string_view name) const;
  /// Whether all that must be given was, and is right: what is not has been told.
  bool is_complete() const;
  /// Where it was given; the object's place if it was not.
  Place place_of(std::string_view name) const;

  bool boolean(std::string_view name) const;
  int64_t integer(std::string_view name) const;
  double number(std::string_view name) const;
  /// Kinds text, choice (in lower case) and file (as given).
  const std::string& text(std::string_view name) const;
  /// Kind number_or_name: the number, or the name in lower case.
  std::variant<double, std::string> number_or_name(std::string_view name) const;
  Vec3d point(std::string_view name) const;
  /// As given: number → Rgb{x, x, x}, Rgb or SpectralCurve.
  std::variant<Rgb, SpectralCurve> color(std::string_view name) const;
  const Transform& transform(std::string_view name) const;
  /// Of the extents that the row asks for; null if it was not given.
  const std::shared_ptr<const Array>& array(std::string_view name) const;

  /// Accepted parameters without effect that were given.
  const std::vector<Property>& ignored() const { return ignored_; }

 private:
  struct Slot {
    Value value;
    bool present = false;
    bool given = false;
    Place place;
  };
  const Slot& slot(std::string_view name) const;
  void accept(const Property& property, Problems& problems);
  void check_stand_ins(Problems& problems) const;
  /// The row that is given instead of one; null if there is none.
  const Parameter* stand_in_of(const Parameter& parameter) const;

  const TypeInfo* info_;
  Place place_;
  std::vector<Slot> slots_;  ///< parallel to info_->parameters
  std::vector<Property> ignored_;
};

/// "'fileFormat' of film 'hdrfilm' (scene.xml:12:7)": as its file has it, for messages.
std::string name_and_place(const Property& property, const std::string& object);
/// "without effect here: …"; the names as name_and_place() gives them.
std::string without_effect(const std::vector<std::string>& names);

/// "number", "boolean", … for messages and help.
std::string kind_name(ParameterKind kind);
/// Of arrays: "[n, 3] of integers"; "" where any will do.
std::string extents_text(const Parameter& parameter);
/// The default as text; "" for none.
std::string default_text(const Parameter& parameter);

}  // namespace kaustik
