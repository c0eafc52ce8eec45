// The parameter tables, as Python's data.

#include <cmath>

#include "bind.h"
#include "kaustik/image/tone_mapping.h"
#include "kaustik/integrator/description_types.h"

namespace kaustik::python {
namespace {

/// As messages of the package call it.
const char* name_of(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::boolean:
      return "boolean";
    case ParameterKind::integer:
      return "integer";
    case ParameterKind::number:
      return "number";
    case ParameterKind::text:
      return "text";
    case ParameterKind::choice:
      return "choice";
    case ParameterKind::number_or_name:
      return "number or name";
    case ParameterKind::point:
      return "point";
    case ParameterKind::color:
      return "color";
    case ParameterKind::transform:
      return "transform";
    case ParameterKind::file:
      return "file";
    case ParameterKind::array:
      break;
  }
  return "array";
}

py::object none_or(double bound) {
  if (std::isinf(bound)) return py::none();
  return py::float_(bound);
}

py::dict parameter_facts(const Parameter& row) {
  py::dict facts;
  facts["name"] = row.name;
  facts["kind"] = name_of(row.kind);
  facts["required"] = row.required;
  facts["default"] = std::holds_alternative<Value>(row.default_value)
                         ? python_value(std::get<Value>(row.default_value))
                         : py::none();
  facts["minimum"] = none_or(row.minimum);
  facts["maximum"] = none_or(row.maximum);
  facts["unit"] = row.unit;
  facts["sentence"] = row.sentence;
  facts["choices"] = row.choices;
  facts["no_effect"] = row.no_effect;
  facts["accepts_texture"] = row.accepts_texture;
  facts["accepts_volume"] = row.accepts_volume;
  facts["instead_of"] = row.stands_for;
  facts["extents"] = row.extents;
  facts["of_integers"] = row.of_integers;
  facts["names_file"] = row.kind == ParameterKind::file;
  return facts;
}

py::dict type_facts(const TypeInfo& info) {
  py::dict facts;
  facts["family"] = info.family;
  facts["name"] = info.name;
  facts["sentence"] = info.sentence;
  py::list parameters;
  for (const Parameter& row : info.parameters) parameters.append(parameter_facts(row));
  facts["parameters"] = parameters;
  return facts;
}

py::list all_types() {
  py::list types;
  for (const TypeInfo* info : description_types().all()) types.append(type_facts(*info));
  for (const ToneOperatorType& type : tone_operator_types()) types.append(type_facts(type.info));
  return types;
}

}  // namespace

void bind_types(py::module_& module) {
  module.def("types", &all_types);
  module.def("nearest_name", &nearest_name);
  module.def("suggest", &suggest);
}

}  // namespace kaustik::python
