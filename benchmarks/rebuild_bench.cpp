// What build_scene() saves where a scene before it shares what has not changed: times of building
// scenes that ship anew, and again after an edit.

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"

namespace {

using namespace kaustik;

constexpr int repeats = 5;

/// Calls `edit` with every object, each once for each parent.
template <typename Edit>
bool edit_first(Object& object, const Edit& edit) {
  if (edit(object)) return true;
  return std::any_of(object.children.begin(), object.children.end(),
                     [&](Child& child) { return edit_first(*child.object, edit); });
}

void set(Object& object, const std::string& name, const Value& value) {
  std::erase_if(object.properties, [&](const Property& p) { return p.name == name; });
  object.properties.push_back({name, value, object.place});
}

/// Moved by a millimetre along x, in the world.
bool moved(Object& object, int step) {
  Transform to_world;
  for (const Property& property : object.properties)
    if (const auto* given = std::get_if<Transform>(&property.value);
        given && property.name == "to_world")
      to_world = *given;
  set(object, "to_world", Transform::translate({0.001 * step, 0, 0}) * to_world);
  return true;
}

struct Edit {
  const char* name;
  bool (*apply)(Object& object, int step);
};

const Edit edits[] = {
    {"nothing", [](Object&, int) { return true; }},
    {"camera", [](Object& o, int step) { return o.family == "sensor" && moved(o, step); }},
    {"material",
     [](Object& o, int step) {
       if (o.type != "diffuse" || !o.children.empty()) return false;
       set(o, "reflectance", Rgb{0.5, 0.5, 0.4 + 0.001 * step});
       return true;
     }},
    {"mesh", [](Object& o, int step) { return o.type == "ply" && moved(o, step); }}};

void measure(const std::string& name) {
  Description description = bench::load_shipped(name);
  auto scene = build_scene(description);
  std::vector<double> anew;
  for (int i = 0; i < repeats; ++i)
    anew.push_back(bench::seconds_of([&] { build_scene(description); }));
  const double base = bench::median(anew);
  bench::report("build/" + name, base, "s", "nothing");
  for (const Edit& edit : edits) {
    std::vector<double> seconds;
    for (int i = 1; i <= repeats; ++i) {
      edit_first(*description.scene, [&](Object& object) { return edit.apply(object, i); });
      seconds.push_back(bench::seconds_of([&] { scene = build_scene(description, scene); }));
    }
    bench::report(fmt::format("rebuild/{}/{}", name, edit.name), bench::median(seconds), "s",
                  fmt::format("{:.4g} s anew", base));
  }
}

}  // namespace

int main() {
  for (const char* name : {"cornell_box", "pool_above", "gallery_1", "museum", "atrium"})
    measure(name);
}
