#include "kaustik/integrator/description_types.h"

#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/scene/type_tables.h"

namespace kaustik {
namespace {

/// The tables of other renderers' integrators, under each of their names, with the parameters of
/// what they are here.
std::vector<TypeInfo> foreign_tables() {
  std::vector<TypeInfo> tables;
  TypeTables native;
  native.add_rows(integrator_types());
  for (const ForeignIntegrator& foreign : foreign_integrators())
    for (const std::string& name : foreign.names) {
      TypeInfo info = foreign.info;
      info.name = name;
      if (const TypeInfo* here = native.find(info.family, foreign.native))
        for (const Parameter& row : here->parameters)
          if (!info.find(row.name)) info.parameters.push_back(row);
      tables.push_back(std::move(info));
    }
  return tables;
}

}  // namespace

const TypeTables& description_types() {
  static const std::vector<TypeInfo> foreign = foreign_tables();
  static const TypeTables types = [] {
    TypeTables all;
    all.add_rows(integrator_types());
    for (const TypeInfo& info : foreign) all.add(info);
    all.add(scene_types());
    return all;
  }();
  return types;
}

}  // namespace kaustik
