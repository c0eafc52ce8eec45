#pragma once
#include <string>
#include <utility>
#include <vector>

#include "kaustik/integrator/registry.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// What other renderers (Mitsuba 0.6 to 3, pbrt-v4, LuxCore) call an integrator, and what it is
/// here.
struct ForeignIntegrator {
  std::vector<std::string> names;  ///< may be Kaustik's own: then these are other spellings
  /// Of the first name: the parameters beside those of the native type.
  TypeInfo info;
  std::string native;  ///< type here; "": that of the integrator which it holds
  /// The same method; else what is nearest.
  bool is_same = true;
  /// Their name, and ours that takes the value; one may stand for several.
  std::vector<std::pair<std::string, std::string>> renamed = {};
  std::vector<Property> implied = {};  ///< what it means where nothing else is given
  bool is_of_layers = false;           ///< it makes layers beside the picture
  std::string refusal = {};            ///< not "": nothing here is near; what to do instead

  bool holds_another() const { return native.empty() && refusal.empty(); }
};

const std::vector<ForeignIntegrator>& foreign_integrators();
/// Null for names that no other renderer has.
const ForeignIntegrator* find_foreign_integrator(const std::string& type);

/// All that integrators may be called.
std::vector<std::string> integrator_names();

/// The integrator as one of Kaustik's own types: where it has another renderer's name, what is
/// meant or what is nearest, with those of its parameters that have a meaning here; of one that
/// holds others (`aov`) the first of them. For a type that nobody knows the integrator in it
/// stands, or Kaustik's default, with its parameters; if it `is_strict`, is like a name
/// that there is, or was given by no file, it stays as it is. What was chosen and left out goes to
/// `notes`. Throws Error for wrong parameters, if it `is_strict` for unknown ones, and for what
/// nothing here is near.
Object native_integrator(const Object& object, std::vector<std::string>& notes,
                         bool is_strict = true);

/// The type of native_integrator() if that is not strict; checks no parameters, throws nothing.
std::string native_type(const Object& object);

/// Whether native_integrator() has added the property because the type implies it.
bool is_implied(const Property& property);

/// Null for names that are not Kaustik's own.
const IntegratorType* find_integrator_type(const std::string& native);

}  // namespace kaustik
