#pragma once
// What a loader makes of a file: a tree of typed objects with named properties, each with its place
// in its file. Plain data; nothing here knows a renderer type.

#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/type_tables.h"

namespace kaustik {

struct Object;

/// A nested object and the name under which its parent holds it ("" if it has none).
struct Child {
  std::string name;
  std::shared_ptr<Object> object;  ///< shared where several parents refer to one object
};

struct Object {
  std::string family;  ///< "scene", "shape", "bsdf", "emitter", "sensor", "film", "rfilter",
                       ///< "sampler", "integrator", "texture", "medium", "phase",
                       ///< "volume"
  std::string type;    ///< "obj", "diffuse", …; "" for the scene itself
  std::string id;      ///< "" if it has none
  std::vector<Property> properties;
  std::vector<Child> children;
  Place place;
};

/// The children of that family in the order in which Mitsuba 3 counts them: by their names, where
/// numbers at the end count as numbers. Those without a name come first, in the order of the file.
std::vector<const Child*> ordered_children(const Object& object, const std::string& family);

/// How a reader deviated from what a file says.
enum class DeviationKind {
  approximated,  ///< the nearest that there is stands for it
  ignored,       ///< it is left out
  missing,       ///< a file is not there; a stand-in is seen in the picture
};

/// "approximated", "ignored", "missing".
std::string_view name_of(DeviationKind kind);

/// Something in a file that is not rendered as it is written.
struct Deviation {
  DeviationKind kind;
  std::string object;  ///< in terms of the file: "material 'glass'"
  std::string what;    ///< a sentence without a full stop
  Place place;
};

/// A whole scene as it was described; file names in it are already relative to the working folder
/// or absolute.
struct Description {
  std::shared_ptr<Object> scene;  ///< never null; its children are the top-level objects
  /// What the loader has read: scene files and spectra.
  std::vector<std::string> sources = {};
  /// What the loader has left out, for the user.
  std::vector<std::string> warnings = {};
  /// Where the loader deviated from the file, in the order of the file.
  std::vector<Deviation> deviations = {};
  /// Whether what no table knows is an error, where otherwise it is left out and told.
  bool is_strict = false;
};

/// The same with objects of its own, shared where they were; numbers in buffers are not copied.
Description copy_of(const Description& description);

/// The path of the file that a property names where the table of its object's type says that it
/// names one; "" for all others, and where the table is null.
std::string file_of(const Property& property, const TypeInfo* info);

/// The files that properties of the scene name: meshes, pictures, photon maps. Those of types
/// without a table do not count.
std::set<std::string> named_files(const Description& description, const TypeTables& types);

}  // namespace kaustik
